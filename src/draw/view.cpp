#include "blackleaf/drawing.h"
#include "blackleaf/error.h"
#include "octree/whole_direction.h"
#include "screen.h"

namespace blackleaf {
namespace {

std::array<std::int64_t, 3> checked(const Eigen::Vector3d& direction) {
  if (!direction.allFinite() || direction.isZero(0))
    throw Error(ErrorCode::bad_argument, "the view direction is zero or not finite", "give a vector like 12,-16,15");
  return detail::whole_direction(direction);
}

}  // namespace

View::View(const Eigen::Vector3d& direction) : direction_(checked(direction)) {
  const detail::Screen screen(direction_);
  for (int i = 0; i < 3; ++i) {
    right_[i] = static_cast<double>(screen.u[static_cast<std::size_t>(i)]) / screen.u_norm;
    up_[i] = static_cast<double>(screen.v[static_cast<std::size_t>(i)]) / screen.v_norm;
  }
}

double LineDrawing::length() const {
  double sum = 0;
  for (const Stroke& stroke : strokes) sum += (stroke.to - stroke.from).norm();
  return sum;
}

}  // namespace blackleaf
