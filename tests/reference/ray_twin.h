// The slow readable twin of rays: all lattice planes that the ray crosses, in order, and the colour half-way between
// each two, in integers of 256 bits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "blackleaf/ray.h"
#include "reference/dense_grid.h"
#include "reference/exact_contact.h"

namespace blackleaf::reference {

/// n / d, d > 0.
struct Fraction {
  Big n = 0, d = 1;
  friend bool operator<(const Fraction& a, const Fraction& b) { return a.n * b.d < b.n * a.d; }
  friend bool operator==(const Fraction& a, const Fraction& b) { return a.n * b.d == b.n * a.d; }
};

struct TwinPoint {
  double time = 0;
  Eigen::Vector3i normal = Eigen::Vector3i::Zero();
};
struct TwinStretch {
  TwinPoint enter, leave;
};

inline std::vector<TwinStretch> crossings(const DenseGrid& grid, const Ray& ray) {
  // Rounded as ray.h says.
  std::array<std::int64_t, 3> origin{}, direction{};
  int exponent = 0;
  std::frexp(ray.direction.cwiseAbs().maxCoeff(), &exponent);
  for (std::size_t i = 0; i < 3; ++i) {
    origin[i] = std::llround(std::ldexp(ray.origin[static_cast<Eigen::Index>(i)], 30));
    direction[i] = std::llround(std::ldexp(ray.direction[static_cast<Eigen::Index>(i)], 39 - exponent));
  }
  struct Event {
    Fraction at;
    double value;
  };
  const auto crossed = [&](std::size_t axis, std::int64_t plane) {
    const std::int64_t way = (plane << 30) - origin[axis], d = direction[axis];
    return Event{{Big(d > 0 ? way : -way), Big(d > 0 ? d : -d)},
                 static_cast<double>(static_cast<long double>(way) / static_cast<long double>(d))};
  };
  std::vector<Event> events = {{{0, 1}, 0}};
  for (std::size_t i = 0; i < 3; ++i)
    for (int p = 0; direction[i] != 0 && p <= grid.side(); ++p)
      if (const Event e = crossed(i, p); Fraction{0, 1} < e.at) events.push_back(e);
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; });

  const auto black_between = [&](const Fraction& from, const Fraction& to) {
    const Fraction middle{from.n * to.d + to.n * from.d, Big(2) * from.d * to.d};
    std::array<std::vector<std::int64_t>, 3> voxels;  // those along which it goes
    for (std::size_t i = 0; i < 3; ++i) {
      const Big at = Big(origin[i]) * middle.d + Big(direction[i]) * middle.n;
      for (int v = -1; v <= grid.side(); ++v) {
        const Big low = Big(std::int64_t{v} << 30) * middle.d, high = Big((std::int64_t{v} + 1) << 30) * middle.d;
        if (!(at < low) && !(high < at)) voxels[i].push_back(v);
      }
    }
    bool black = true;
    for (const std::int64_t x : voxels[0])
      for (const std::int64_t y : voxels[1])
        for (const std::int64_t z : voxels[2]) black = black && grid.at(x, y, z);
    return black && !voxels[0].empty() && !voxels[1].empty() && !voxels[2].empty();
  };
  const auto point = [&](const Event& event, bool entering) {
    TwinPoint result;
    result.time = std::ldexp(event.value, 9 - exponent);
    for (std::size_t i = 0; i < 3 && Fraction{0, 1} < event.at && result.normal == Eigen::Vector3i::Zero(); ++i)
      for (int p = 0; direction[i] != 0 && p <= grid.side(); ++p)
        if (crossed(i, p).at == event.at)
          result.normal[static_cast<Eigen::Index>(i)] = (direction[i] > 0) == entering ? -1 : 1;
    return result;
  };
  std::vector<TwinStretch> result;
  bool before = false;
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (k + 1 < events.size() && events[k].at == events[k + 1].at) continue;
    const bool black = k + 1 < events.size() && black_between(events[k].at, events[k + 1].at);
    if (black && !before) result.push_back({point(events[k], true), {}});
    if (!black && before) result.back().leave = point(events[k], false);
    before = black;
  }
  return result;
}

}  // namespace blackleaf::reference
