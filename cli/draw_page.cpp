#include "draw_page.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "blackleaf/error.h"
#include "files.h"

namespace blackleaf::cli {
namespace {

constexpr const char* kSuffixes = ".svg, .pdf, .png, .hpgl, .dxf or .json";

std::optional<PictureFormat> format_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PictureFormat>, 7> kNames{{{"svg", PictureFormat::svg},
                                                                                     {"pdf", PictureFormat::pdf},
                                                                                     {"png", PictureFormat::png},
                                                                                     {"hpgl", PictureFormat::hpgl},
                                                                                     {"plt", PictureFormat::hpgl},
                                                                                     {"dxf", PictureFormat::dxf},
                                                                                     {"json", PictureFormat::json}}};
  for (const auto& [known, format] : kNames)
    if (known == name) return format;
  return std::nullopt;
}

}  // namespace

void PageArguments::add_to(App& app) {
  add_text(app, "--format", format_, "FORMAT", "svg, hpgl, dxf or json, for -o -");
  add_text(app, "--size", size_, "SIZE",
           "page: A0 to A6, turned to suit the picture, or WxH in mm (default: the drawing's shape, 180 mm)");
  add_text(
      app, "--order", order_, "ORDER",
      "for the pen: strokes (each a line of its own, those that meet in a row), chains (joined into long lines) or "
      "none (default: chains in HP-GL, none in PNG and JSON, else strokes)");
  add_text(app, "--title", title_, "TEXT", "what the picture says it shows (default: the files' names)");
  app.add_flag("--stats", stats_, "tell how far a pen travels, before and after ordering");
}

PictureFormat PageArguments::format(const std::string& output) const {
  if (format_ && !format_named(*format_))
    throw Error(ErrorCode::bad_argument, fmt::format("--format is '{}', which is unknown", *format_),
                "use svg, pdf, png, hpgl, dxf or json");
  if (output == "-") {
    if (!format_ || *format_ == "png" || *format_ == "pdf")
      throw Error(ErrorCode::bad_argument, "-o - can print svg, hpgl, dxf or json only",
                  "say --format svg or --format json, for example");
    return format_named(*format_).value();
  }
  const std::string suffix = suffix_of(output);
  const auto from_suffix = format_named(std::string_view(suffix).substr(suffix.empty() ? 0 : 1));
  if (!from_suffix)
    throw Error(ErrorCode::bad_argument, fmt::format("cannot draw to '{}': unknown suffix '{}'", output, suffix),
                fmt::format("use {}", kSuffixes));
  if (format_ && format_named(*format_) != from_suffix)
    throw Error(ErrorCode::bad_argument, fmt::format("--format {} contradicts the suffix of '{}'", *format_, output),
                "leave it out");
  return *from_suffix;
}

void PageArguments::check(bool in_voxels, bool pens) const {
  if (order_ && *order_ != "strokes" && *order_ != "chains" && *order_ != "none")
    throw Error(ErrorCode::bad_argument, fmt::format("--order is '{}', which is unknown", *order_),
                "use strokes, chains or none");
  if (in_voxels)
    for (const auto& [given, name] : {std::pair{size_.has_value(), "--size"},
                                      {pens, "a pen's option"},
                                      {order_.has_value(), "--order"},
                                      {title_.has_value(), "--title"},
                                      {stats_, "--stats"}})
      if (given)
        throw Error(ErrorCode::bad_argument, fmt::format("{} does not apply to JSON, which has no page", name),
                    "leave it out");
  if (!size_) return;
  const PageSize size = parse_page_size("--size", *size_);
  if (const double margins = 2 * PageOptions{}.margin_mm; std::min(size.width_mm, size.height_mm) <= margins)
    throw Error(ErrorCode::bad_argument,
                fmt::format("--size is '{}', which the margins of {} mm fill", *size_, margins / 2),
                fmt::format("make both sides longer than {} mm", margins));
}

PageOptions PageArguments::page_for(std::span<const Layer> layers) const {
  PageOptions page;
  page.title = title_.value_or("");
  if (!size_) return page;
  const PageSize size = parse_page_size("--size", *size_);
  page.width_mm = size.width_mm;
  page.height_mm = size.height_mm;
  if (!size.named) return page;
  // A named page lies down for a picture that is wider than high.
  Eigen::AlignedBox2d box;
  for (const Layer& layer : layers)
    for (const Eigen::Vector2d& point : layer.lines.points()) box.extend(point);
  if (!box.isEmpty() && box.sizes().x() > box.sizes().y()) std::swap(page.width_mm, page.height_mm);
  return page;
}

std::optional<Joining> PageArguments::joining(PictureFormat format) const {
  if (order_) {
    if (*order_ == "none") return std::nullopt;
    return *order_ == "chains" ? Joining::chains : Joining::strokes;
  }
  if (format == PictureFormat::hpgl) return Joining::chains;
  // On a screen or a printer nothing travels; --stats wants the order all the same.
  if (format == PictureFormat::png || format == PictureFormat::json)
    return stats_ ? std::optional(Joining::strokes) : std::nullopt;
  return Joining::strokes;
}

OrderedPicture ordered_picture(Picture picture, std::optional<Joining> joining) {
  OrderedPicture result;
  result.before = pen_travel(picture);
  result.picture = joining ? in_pen_order(picture, *joining) : std::move(picture);
  result.after = pen_travel(result.picture);
  return result;
}

std::string text_of(const Picture& picture, PictureFormat format) {
  switch (format) {
    case PictureFormat::hpgl:
      return to_hpgl(picture);
    case PictureFormat::dxf:
      return to_dxf(picture);
    case PictureFormat::json:
      return to_json(picture);
    default:
      return to_svg(picture);
  }
}

std::string stats_text(const PenTravel& before, const PenTravel& after) {
  const auto line = [](const char* when, const PenTravel& t) {
    return fmt::format("{}: {} strokes, pen down {:.1f} mm, pen up {:.1f} mm, {} pen lifts\n", when, grouped(t.strokes),
                       t.down_mm, t.up_mm, grouped(t.lifts));
  };
  return line("as drawn", before) + line("in order", after);
}

Json stats_json(const PenTravel& travel) {
  return {
      {"strokes", travel.strokes}, {"pen_down", travel.down_mm}, {"pen_up", travel.up_mm}, {"pen_lifts", travel.lifts}};
}

}  // namespace blackleaf::cli
