#include "draw_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blackleaf/error.h"

namespace blackleaf::cli {
namespace {

// The side of a voxel in world units; none where the frame's axes stretch or bend the picture.
std::optional<double> voxel_side(const Frame& frame) {
  const Eigen::Matrix3d gram = frame.axes.transpose() * frame.axes;
  const double square = gram.trace() / 3;
  if (!(square > 0) || !(gram - square * Eigen::Matrix3d::Identity()).isZero(1e-6 * square)) return std::nullopt;
  return std::sqrt(square);
}

}  // namespace

void SheetArguments::add_to(App& app) {
  app.add_flag("--sheet", sheet_,
               "engineering sheet: front, top and side views and an isometric one, with a title block");
  add_text(app, "--angle", angle_, "first|third", "of --sheet: how views are placed (default third)");
  add_text(app, "--scale", scale_, "A:B",
           "of --sheet: A mm on the page for B in the world (default: the largest standard one that fits)");
  add_text(app, "--date", date_, "TEXT", "of --sheet: for the title block (default: none)");
}

ProjectionAngle SheetArguments::angle() const {
  if (!angle_ || *angle_ == "third") return ProjectionAngle::third;
  if (*angle_ == "first") return ProjectionAngle::first;
  throw Error(ErrorCode::bad_argument, fmt::format("--angle is '{}', which is unknown", *angle_), "use first or third");
}

double SheetArguments::scale() const {
  if (!scale_) return 0;
  const std::size_t colon = scale_->find(':');
  if (colon == std::string::npos)
    throw Error(ErrorCode::bad_argument, fmt::format("--scale is '{}', which is no ratio", *scale_),
                "write it like 2:1 or 1:5");
  const double page = parse_number("--scale", scale_->substr(0, colon));
  const double world = parse_number("--scale", scale_->substr(colon + 1));
  if (!(page > 0) || !(world > 0) || !std::isfinite(page / world) || !(page / world > 0))
    throw Error(ErrorCode::bad_argument, fmt::format("--scale is '{}', which is not above zero", *scale_),
                "write it like 2:1 or 1:5");
  return page / world;
}

void SheetArguments::check(const std::optional<std::string>& size) const {
  for (const auto& [text, name] : {std::pair{&angle_, "--angle"}, {&scale_, "--scale"}, {&date_, "--date"}})
    if (*text && !sheet_)
      throw Error(ErrorCode::bad_argument, fmt::format("{} belongs to --sheet", name), "add --sheet or leave it out");
  if (!sheet_) return;
  static_cast<void>(angle());
  static_cast<void>(scale());
  if (size) static_cast<void>(parse_page_size("--size", *size));
}

SheetOptions SheetArguments::options(const std::optional<std::string>& size, const std::string& title,
                                     const std::string& source, const Frame& frame) const {
  SheetOptions sheet;
  const PageSize page = parse_page_size("--size", size.value_or("A4"));
  sheet.width_mm = page.width_mm;
  sheet.height_mm = page.height_mm;
  sheet.size_name = fmt::format("{:g} x {:g}", page.width_mm, page.height_mm);
  if (page.named) {
    if (sheet.width_mm < sheet.height_mm) std::swap(sheet.width_mm, sheet.height_mm);
    sheet.size_name = size.value_or("A4");
    sheet.size_name[0] = 'A';
  }
  sheet.angle = angle();
  sheet.scale = scale();
  sheet.title = title;
  sheet.source = source;
  sheet.date = date_.value_or("");
  if (const auto side = voxel_side(frame); side && frame.unit != "voxel") {
    sheet.voxel_mm = *side;
    if (frame.unit != "mm") sheet.scale_note = fmt::format("1 {} = 1 mm", frame.unit);
  } else {
    sheet.scale_note = "1 voxel = 1 mm";
  }
  return sheet;
}

}  // namespace blackleaf::cli
