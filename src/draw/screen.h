// Screen: the picture's axes u and v with whole-number components, so that rounding comes last.
//
// u = U / u_norm, v = V / v_norm with U = up x d and V = d x U; for up = +z, h^2 = dx^2 + dy^2:
// U = (-dy, dx, 0), u_norm = h; V = (-dx dz, -dy dz, h^2), v_norm = h |d|. |U_i| <= 2^20, |V_i| <= 2^41.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace blackleaf::detail {

struct Screen {
  std::array<std::int64_t, 3> u, v;
  double u_norm, v_norm;

  /// Requires: d is not zero.
  explicit Screen(const std::array<std::int64_t, 3>& d) {
    const std::int64_t h2 = d[0] * d[0] + d[1] * d[1];
    if (h2 == 0) {  // up is +y: u = y x d, v = d x u = y
      u = {d[2] > 0 ? 1 : -1, 0, 0};
      v = {0, 1, 0};
      u_norm = v_norm = 1;
    } else {
      u = {-d[1], d[0], 0};
      v = {-d[0] * d[2], -d[1] * d[2], h2};
      u_norm = std::sqrt(static_cast<double>(h2));
      v_norm = u_norm * std::sqrt(static_cast<double>(h2 + d[2] * d[2]));
    }
  }
};

}  // namespace blackleaf::detail
