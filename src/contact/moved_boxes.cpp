#include "moved_boxes.h"

namespace blackleaf::detail {
namespace {

IntegerBox integer_box(const BoxNode& box) {
  IntegerBox result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.low[i] = static_cast<std::int32_t>(box.centre[i] - box.half[i]);
    result.high[i] = static_cast<std::int32_t>(box.centre[i] + box.half[i]);
  }
  return result;
}

}  // namespace

MovedBoxes::MovedBoxes(const Motion& motion) {
  if (motion.translation().norm() > FixedMotion::kMaxTranslation) {
    map_ = {motion.rotation(), motion.translation()};
    return;
  }
  const FixedMotion fixed(motion);
  exact_.emplace(fixed);
  // 64 bits of mantissa: relative errors below 2^-60, and those of one rounding to double.
  using Wide = long double;
  Eigen::Matrix<Wide, 3, 3> a;
  Eigen::Matrix<Wide, 3, 1> b;
  constexpr Wide kUnit = 0x1p-38L;
  for (int i = 0; i < 3; ++i) {
    b[i] = static_cast<Wide>(fixed.inverse_translation[static_cast<std::size_t>(i)]) * kUnit;
    for (int j = 0; j < 3; ++j)
      a(i, j) =
          static_cast<Wide>(fixed.inverse_rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]) * kUnit;
  }
  const Eigen::Matrix<Wide, 3, 3> inverse = a.inverse();
  map_.rotation = inverse.cast<double>();
  map_.shift = (-(inverse * b)).cast<double>();
}

bool MovedBoxes::touch(const BoxNode& a, const BoxNode& b) const {
  return exact_ && exact_->touch(integer_box(a), integer_box(b));
}

}  // namespace blackleaf::detail
