#include "peers/scanline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "blackleaf/leaves.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

__extension__ using Wide = __int128;
using Point = std::array<std::int64_t, 3>;  // in units of 2^(depth-40) voxels, below 2^41

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

Wide ceiling(Wide dividend, Wide divisor) {  // Requires: divisor > 0.
  const Wide quotient = dividend / divisor;
  return quotient * divisor < dividend ? quotient + 1 : quotient;
}

// On which side of the edge from a to b, seen along x, lies the column (y, z)? It counts as moved by (e, e^2).
int side_of(const Point& a, const Point& b, std::int64_t y, std::int64_t z) {
  const Wide dy = b[1] - a[1], dz = b[2] - a[2];
  if (const int s = sign(dy * (z - a[2]) - dz * (y - a[1]))) return s;
  if (const int s = sign(-dz)) return s;
  return sign(dy);
}

class Rows {
 public:
  Rows(int depth, std::vector<std::uint8_t>& voxels)
      : depth_(depth),
        unit_(std::int64_t{1} << (39 - depth)),
        voxels_(voxels),
        crossed_(std::size_t{1} << (2 * depth)) {
    voxels_.assign(std::size_t{1} << (3 * depth), 0);
  }

  // Changes the first voxel beyond the triangle in every row that passes it.
  void cross(const Point& a, const Point& b, const Point& c) {
    const auto [first_y, last_y] = centres(std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}));
    const auto [first_z, last_z] = centres(std::min({a[2], b[2], c[2]}), std::max({a[2], b[2], c[2]}));
    if (first_y > last_y || first_z > last_z) return;
    const auto normal = [&](std::size_t j, std::size_t k) {
      return Wide{b[j] - a[j]} * (c[k] - a[k]) - Wide{b[k] - a[k]} * (c[j] - a[j]);
    };
    std::array<Wide, 3> n = {normal(1, 2), normal(2, 0), normal(0, 1)};
    if (n[0] == 0) return;  // no row passes a triangle that is seen as a line
    if (n[0] < 0)
      for (Wide& component : n) component = -component;
    for (std::int64_t row_z = first_z; row_z <= last_z; ++row_z)
      for (std::int64_t row_y = first_y; row_y <= last_y; ++row_y) {
        const std::int64_t y = (2 * row_y + 1) * unit_, z = (2 * row_z + 1) * unit_;
        const int s = side_of(a, b, y, z);
        if (side_of(b, c, y, z) != s || side_of(c, a, y, z) != s) continue;
        // The first x whose centre (2 x + 1) unit is on the plane or beyond it.
        const Wide plane = n[0] * a[0] - n[1] * (y - a[1]) - n[2] * (z - a[2]);
        const Wide x = std::max(Wide{0}, ceiling(plane - n[0] * unit_, n[0] * 2 * unit_));
        const auto row = static_cast<std::size_t>(row_z << depth_ | row_y);
        if (x >> depth_ != 0) continue;
        voxels_[row << depth_ | static_cast<std::size_t>(x)] ^= 1;
        crossed_[row] = 1;
      }
  }

  // From changes to colours: each byte becomes the exclusive or of its row up to there, eight bytes at a time.
  void fill() {
    const std::size_t side = std::size_t{1} << depth_;
    for (std::size_t row = 0; row < crossed_.size(); ++row) {
      if (!crossed_[row]) continue;
      std::uint64_t colour = 0;
      for (std::uint8_t *at = &voxels_[row * side], *end = at + side; at != end; at += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, at, 8);
        word ^= word << 8;
        word ^= word << 16;
        word ^= word << 32;
        word ^= colour * 0x0101010101010101;
        colour = word >> 56;
        std::memcpy(at, &word, 8);
      }
    }
  }

 private:
  // The rows whose centres are in [low, high].
  std::pair<std::int64_t, std::int64_t> centres(std::int64_t low, std::int64_t high) const {
    return {std::max<std::int64_t>(0, (low + unit_ - 1) / (2 * unit_)),
            std::min((std::int64_t{1} << depth_) - 1, (high + unit_) / (2 * unit_) - 1)};
  }

  int depth_;
  std::int64_t unit_;  // half a voxel
  std::vector<std::uint8_t>& voxels_;
  std::vector<std::uint8_t> crossed_;  // by row
};

}  // namespace

void scanline_bunny(int depth, std::vector<std::uint8_t>& voxels) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& p : bunny_points(depth)) {
    const auto rounded = [&](double coordinate) { return std::llround(std::ldexp(coordinate, 40 - depth)); };
    points.push_back({rounded(p.x()), rounded(p.y()), rounded(p.z())});
  }
  Rows rows(depth, voxels);
  for (const auto& t : bunny_mesh().triangles) rows.cross(points[t[0]], points[t[1]], points[t[2]]);
  rows.fill();
}

WrongVoxels::WrongVoxels(int depth)
    : depth_(depth),
      volume_([&]() -> const std::vector<std::uint8_t>& {
        static std::map<int, std::vector<std::uint8_t>> made;
        auto& volume = made[depth];
        if (volume.empty()) scanline_bunny(depth, volume);
        return volume;
      }()),
      black_(std::count(volume_.begin(), volume_.end(), 1)) {}

void WrongVoxels::add(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t size_x, std::int64_t size_y,
                      std::int64_t size_z) {
  for (std::int64_t at_z = z; at_z < z + size_z; ++at_z)
    for (std::int64_t at_y = y; at_y < y + size_y; ++at_y) {
      const auto row = volume_.begin() + ((at_z << depth_ | at_y) << depth_ | x);
      const std::int64_t right = std::count(row, row + size_x, 1);
      rightly_black_ += right;
      wrongly_black_ += size_x - right;
    }
}

void add_scanline() {
  for (const int depth : {8, 9, 10}) {
    const std::string side = side_name(depth);
    contender("mesh/" + side + "/t1", "scanline", [=](benchmark::State& state) {
      std::vector<std::uint8_t> voxels;
      scanline_bunny(depth, voxels);  // not the first time that memory is touched
      for (auto _ : state) {
        scanline_bunny(depth, voxels);
        benchmark::DoNotOptimize(voxels.data());
      }
    });
    counted("wrong/" + side, "ours", [=] {
      WrongVoxels wrong(depth);
      for_each_black_leaf(bunny(depth), [&](const Leaf& leaf) {
        const Cube& c = leaf.cube;
        wrong.add(c.x, c.y, c.z, c.side(), c.side(), c.side());
      });
      return wrong.count();
    });
  }
}

}  // namespace blackleaf::bench
