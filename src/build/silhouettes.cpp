// Octrees from silhouettes. See docs/SILHOUETTES.md.
#include "blackleaf/silhouettes.h"

#include <bit>
#include <cmath>
#include <numeric>
#include <string>

#include "blackleaf/error.h"
#include "octree/brick.h"
#include "octree/produce.h"
#include "octree/whole_direction.h"
#include "pixel_walls.h"

namespace blackleaf {
namespace {

using detail::PixelSize;
using detail::PixelWalls;
using detail::Wide;
using Vector = std::array<std::int64_t, 3>;

// a x b without common divisors. Requires: |a| |b| < 2^63.
Vector cross(const Vector& a, const Vector& b) {
  Vector c{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    c[i] = static_cast<std::int64_t>(Wide{a[j]} * b[k] - Wide{a[k]} * b[j]);
  }
  const std::int64_t divisor = std::gcd(std::gcd(c[0], c[1]), c[2]);
  if (divisor > 1)
    for (std::int64_t& component : c) component /= divisor;
  return c;
}

bool points_somewhere(const Eigen::Vector3d& v) { return v.allFinite() && !v.isZero(0); }

// The picture's axes: along its columns and, downward, along its rows.
struct Axes {
  Vector columns, rows;
};

Axes axes_of(const Silhouette& s) {
  const Vector d = detail::whole_direction(s.view);
  const bool upright = d[0] == 0 && d[1] == 0;
  const Vector up = s.up ? detail::whole_direction(*s.up) : upright ? Vector{0, 1, 0} : Vector{0, 0, 1};
  const Vector u = cross(up, d);
  return {u, cross(u, d)};  // u x d = -(d x u): downward
}

void require_sound(const std::vector<Silhouette>& silhouettes, int depth) {
  if (depth < 1 || depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(depth) + " is out of range", "use 1 to 20");
  if (silhouettes.empty())
    throw Error(ErrorCode::bad_argument, "there are no silhouettes", "give one at least; three make a good solid");
  for (std::size_t i = 0; i < silhouettes.size(); ++i) {
    const Silhouette& s = silhouettes[i];
    const auto fail = [&](const std::string& what, const std::string& remedy) {
      throw Error(ErrorCode::bad_argument, "silhouette " + std::to_string(i) + " " + what, remedy);
    };
    if (s.width < 1 || s.height < 1) fail("has no pixels", "give an image with some");
    const std::int64_t pixels = std::int64_t{s.width} * s.height;
    if (pixels >= std::int64_t{1} << 30) fail("has 2^30 pixels or more", "make it smaller");
    if (static_cast<std::int64_t>(s.pixels.size()) != pixels)
      fail("has " + std::to_string(s.pixels.size()) + " pixels instead of " + std::to_string(pixels),
           "give width x height of them");
    if (!points_somewhere(s.view)) fail("has a view that is zero or not finite", "give a direction like 1,0,0");
    if (s.up && !points_somewhere(*s.up)) fail("has an up that is zero or not finite", "give a direction like 0,0,1");
    if (s.up && detail::parallel(s.view, *s.up)) fail("has an up parallel to its view", "give another, or none");
    if (s.pixel_size && !(*s.pixel_size >= 0x1p-30 && *s.pixel_size <= 0x1p30))
      fail("has a pixel size that is not between 2^-30 and 2^30 voxels", "give the side of a pixel in voxels");
  }
}

// Pixels from first to last, both included.
struct Rectangle {
  std::int32_t first_column, last_column, first_row, last_row;
};

// One silhouette, ready to be asked.
class Picture {
 public:
  Picture(const Silhouette& s, int depth)
      : Picture(
            s, axes_of(s),
            s.pixel_size ? PixelSize::of(*s.pixel_size) : PixelSize{1, static_cast<std::uint64_t>(s.width), depth}) {}

  bool object(std::int32_t column, std::int32_t row) const {
    if (column < 0 || row < 0 || column >= columns_.count() || row >= rows_.count()) return false;
    return object_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_.count()) +
                   static_cast<std::size_t>(column)] != 0;
  }

  // Where the box of points q with low <= q <= high is seen: all in the object, all outside it, or (gray) unknown.
  Colour classify(const std::array<std::int32_t, 3>& low, const std::array<std::int32_t, 3>& high) const {
    const auto [left, right] = span(columns_, low, high);
    const auto [top, bottom] = span(rows_, low, high);
    if (right < 0 || bottom < 0 || left >= columns_.count() || top >= rows_.count()) return Colour::white;
    const Rectangle seen = {std::max(left, 0), std::min(right, columns_.count() - 1), std::max(top, 0),
                            std::min(bottom, rows_.count() - 1)};
    const std::uint32_t found = count(seen);
    if (found == 0) return Colour::white;
    const bool within = left >= 0 && top >= 0 && right < columns_.count() && bottom < rows_.count();
    const std::int64_t all =
        std::int64_t{seen.last_column - seen.first_column + 1} * (seen.last_row - seen.first_row + 1);
    return within && found == all ? Colour::black : Colour::gray;
  }

  // The voxels of a brick whose centres are in the object; q is that of the first.
  std::uint64_t brick(const std::array<std::int32_t, 3>& q) const {
    const Wide column = columns_.place(q), row = rows_.place(q);
    const Vector &u = columns_.axis(), &v = rows_.axis();
    std::uint64_t bits = 0;
    for (unsigned z = 0; z < 4; ++z)
      for (unsigned y = 0; y < 4; ++y)
        for (unsigned x = 0; x < 4; ++x) {
          const auto shifted = [&](Wide place, const Vector& axis) {
            return place + 2 * (Wide{axis[0]} * x + Wide{axis[1]} * y + Wide{axis[2]} * z);
          };
          const bool black = object(columns_.pixel(shifted(column, u)), rows_.pixel(shifted(row, v)));
          bits |= std::uint64_t{black} << detail::brick_bit(x, y, z);
        }
    return bits;
  }

 private:
  Picture(const Silhouette& s, const Axes& axes, const PixelSize& size)
      : object_(s.pixels), columns_(axes.columns, s.width, size), rows_(axes.rows, s.height, size) {
    // sums_[r (width + 1) + c]: object pixels above row r and left of column c.
    const std::size_t stride = static_cast<std::size_t>(s.width) + 1;
    sums_.resize(stride * (static_cast<std::size_t>(s.height) + 1));
    for (std::size_t row = 0; row < static_cast<std::size_t>(s.height); ++row) {
      std::uint32_t in_row = 0;
      for (std::size_t column = 0; column + 1 < stride; ++column) {
        in_row += s.pixels[row * (stride - 1) + column] != 0;
        sums_[(row + 1) * stride + column + 1] = sums_[row * stride + column + 1] + in_row;
      }
    }
  }

  static std::pair<std::int32_t, std::int32_t> span(const PixelWalls& walls, std::array<std::int32_t, 3> low,
                                                    std::array<std::int32_t, 3> high) {
    for (std::size_t i = 0; i < 3; ++i)
      if (walls.axis()[i] < 0) std::swap(low[i], high[i]);
    return {walls.pixel(walls.place(low)), walls.pixel(walls.place(high))};
  }

  std::uint32_t count(const Rectangle& r) const {
    const std::size_t stride = static_cast<std::size_t>(columns_.count()) + 1;
    const std::size_t above = static_cast<std::size_t>(r.first_row) * stride;
    const std::size_t below = (static_cast<std::size_t>(r.last_row) + 1) * stride;
    const std::size_t left = static_cast<std::size_t>(r.first_column);
    const std::size_t right = static_cast<std::size_t>(r.last_column) + 1;
    return sums_[below + right] - sums_[above + right] - sums_[below + left] + sums_[above + left];
  }

  const std::vector<std::uint8_t>& object_;
  PixelWalls columns_, rows_;
  std::vector<std::uint32_t> sums_;
};

// A node is known by the pictures in which some of it may be outside the object: those seen wholly inside are not asked
// again below. Bit i speaks of the pictures i, i + 64, i + 128, ...
struct SilhouetteProducer {
  struct Task {
    std::uint64_t open;
  };
  const std::vector<Picture>& pictures;
  int depth;

  // q (pixel_walls.h) of the centre of the cube's first voxel.
  std::array<std::int32_t, 3> first(const Cube& cube) const {
    const std::int32_t middle = (std::int32_t{1} << depth) - 1;
    return {2 * cube.x - middle, 2 * cube.y - middle, 2 * cube.z - middle};
  }

  Task root() const { return {~std::uint64_t{0} >> (pictures.size() < 64 ? 64 - pictures.size() : 0)}; }
  Colour classify(Task& task, const Cube& cube) const {
    if (cube.level > depth) return Colour::gray;
    const std::array<std::int32_t, 3> low = first(cube);
    std::array<std::int32_t, 3> high = low;
    for (std::int32_t& q : high) q += 2 * (cube.side() - 1);
    std::uint64_t still_open = 0;
    for (std::uint64_t rest = task.open; rest; rest &= rest - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
      for (std::size_t i = bit; i < pictures.size(); i += 64) {
        const Colour colour = pictures[i].classify(low, high);
        if (colour == Colour::white) return Colour::white;
        if (colour == Colour::gray) still_open |= std::uint64_t{1} << bit;
      }
    }
    task.open = still_open;
    return still_open ? Colour::gray : Colour::black;
  }
  Task child(const Task& task, const Cube&, int) const { return task; }
  std::uint64_t brick(const Task& task, const Cube& cube) const {
    std::uint64_t bits = ~std::uint64_t{0};
    for (std::uint64_t rest = task.open; rest; rest &= rest - 1)
      for (auto i = static_cast<std::size_t>(std::countr_zero(rest)); i < pictures.size() && bits; i += 64)
        bits &= pictures[i].brick(first(cube));
    return bits;
  }
};

}  // namespace

Octree octree_from_silhouettes(const std::vector<Silhouette>& silhouettes, int depth, Frame frame, const Work& work) {
  require_sound(silhouettes, depth);
  std::vector<Picture> pictures;
  pictures.reserve(silhouettes.size());
  for (const Silhouette& silhouette : silhouettes) pictures.emplace_back(silhouette, depth);
  return detail::produce(SilhouetteProducer{pictures, depth}, depth, std::move(frame), work);
}

}  // namespace blackleaf
