#include "picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blackleaf/error.h"

namespace blackleaf::cli {

void PictureOptions::add_to(App& app) {
  add_text(app, "--size", size_text_, "SIZE",
           "page: A0 to A6, turned to suit the picture, or WxH in mm (default: the drawing's shape, 180 mm)");
  add_number(app, "--pen-width", pen_width_, true, "width of the lines in mm (default 0.25)");
}

void PictureOptions::check(const std::string& kind) {
  const bool page = kind == "svg" || kind == "png" || kind == "pdf";
  if (!page && (size_text_ || pen_width_))
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} does not apply to {}, which has no page", size_text_ ? "--size" : "--pen-width",
                            kind == "json" ? "JSON" : "an octree"),
                "leave it out");
  if (!size_text_) return;
  size_ = parse_page_size("--size", *size_text_);
  const double margins = 2 * PageOptions{}.margin_mm;
  if (std::min(size_.width_mm, size_.height_mm) <= margins)
    throw Error(ErrorCode::bad_argument,
                fmt::format("--size is '{}', which the margins of {} mm fill", *size_text_, margins / 2),
                fmt::format("make both sides longer than {} mm", margins));
}

PageOptions PictureOptions::page(const Eigen::AlignedBox2d& box) const {
  PageOptions page;
  if (pen_width_) page.pen_width_mm = *pen_width_;
  page.width_mm = size_.width_mm;
  page.height_mm = size_.height_mm;
  if (size_.named && !box.isEmpty() && box.sizes().x() > box.sizes().y()) std::swap(page.width_mm, page.height_mm);
  return page;
}

Eigen::AlignedBox2d box_of(const LineDrawing& drawing) {
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : drawing.strokes) box.extend(stroke.from).extend(stroke.to);
  return box;
}

View parse_view(const std::string& text) {
  const Eigen::Vector3d direction = parse_vector("--view", text);
  if (direction.isZero(0))
    throw Error(ErrorCode::bad_argument, "--view is zero, which is no direction", "give one like 3,-4,2");
  return View(direction);
}

}  // namespace blackleaf::cli
