#include "draw_eye.h"

#include <fmt/format.h>

#include <numbers>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"

namespace blackleaf::cli {

void EyeArguments::add_to(App& app) {
  add_text(app, "--eye", eye_, "x,y,z", "draw in perspective, seen from this point, in voxels; instead of --view");
  add_text(app, "--target", target_, "x,y,z",
           "of --eye: the point it looks at, drawn at its true size (default: the middle of the bounding box)");
  add_number(app, "--fov", field_of_view_, true,
             "of --eye: the field of view in degrees, 1 to 170 (default 120); what lies outside is not drawn");
}

void EyeArguments::check(const std::optional<std::string>& other_view) const {
  if (!given() && (target_ || field_of_view_))
    throw Error(ErrorCode::bad_argument, fmt::format("{} belongs to --eye", target_ ? "--target" : "--fov"),
                "add --eye x,y,z or leave it out");
  if (!given()) return;
  if (other_view)
    throw Error(ErrorCode::bad_argument, fmt::format("--eye and {} are two views", *other_view), "leave one out");
  if (field_of_view_ && !(*field_of_view_ >= 1 && *field_of_view_ <= 170))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--fov is {}, which is not from 1 to 170 degrees", *field_of_view_),
                "give an angle like 60");
  static_cast<void>(parse_vector("--eye", *eye_));
  if (target_) static_cast<void>(parse_vector("--target", *target_));
}

Perspective EyeArguments::perspective(const Octree& all) const {
  Eigen::Vector3d target = Eigen::Vector3d::Constant(all.side() / 2.0);
  if (target_) {
    target = parse_vector("--target", *target_);
  } else if (const std::optional<Box> box = bounding_box(all)) {
    for (std::size_t i = 0; i < 3; ++i) target[static_cast<Eigen::Index>(i)] = (box->min[i] + box->max[i]) / 2.0;
  }
  const double angle = field_of_view_ ? *field_of_view_ * std::numbers::pi / 180 : Perspective::kWidest;
  return Perspective(parse_vector("--eye", *eye_), target, angle);
}

}  // namespace blackleaf::cli
