#include "blackleaf/silhouettes.h"

#include <limits>
#include <string>

#include "blackleaf/error.h"
#include "build/pixel_walls.h"
#include "meshes.h"
#include "octree/whole_direction.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using detail::PixelSize;
using detail::PixelWalls;
using reference::DenseGrid;
using testing::error_of;
using Wide = detail::Wide;
using Vector = std::array<std::int64_t, 3>;

// ---- the twin: one voxel and one pixel boundary at a time

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide dot(const Vector& a, const Vector& b) { return Wide{a[0]} * b[0] + Wide{a[1]} * b[1] + Wide{a[2]} * b[2]; }

// value >= factor * sqrt(square), squared only once the signs are known
bool at_least(Wide value, Wide factor, Wide square) {
  if (factor <= 0 && value >= 0) return true;
  if (factor >= 0 && value < 0) return false;
  return factor > 0 ? value * value >= factor * factor * square : value * value <= factor * factor * square;
}

// The pixel of a row or column of `count` pixels of side whole / part.
int pixel_of(const Vector& q, const Vector& axis, int count, std::int64_t whole, std::int64_t part) {
  int pixel = -1;
  for (int k = 0; k <= count; ++k)
    if (at_least(dot(axis, q) * part, Wide{2 * k - count} * whole, dot(axis, axis))) pixel = k;
  return pixel;
}

struct TwinView {
  Vector view, up;
  std::int64_t whole, part;  // of the pixel size
};

DenseGrid carved(const std::vector<Silhouette>& pictures, const std::vector<TwinView>& views, int depth) {
  DenseGrid grid(depth);
  const std::int64_t side = grid.side();
  grid.for_each([&](int x, int y, int z, bool) {
    const Vector q = {2 * x + 1 - side, 2 * y + 1 - side, 2 * z + 1 - side};
    bool black = true;
    for (std::size_t i = 0; i < views.size() && black; ++i) {
      const Vector u = cross(views[i].up, views[i].view), down = cross(u, views[i].view);
      const Silhouette& s = pictures[i];
      const int column = pixel_of(q, u, s.width, views[i].whole, views[i].part);
      const int row = pixel_of(q, down, s.height, views[i].whole, views[i].part);
      black = column >= 0 && row >= 0 && column < s.width && row < s.height &&
              s.pixels[static_cast<std::size_t>(row * s.width + column)] != 0;
    }
    grid.set(x, y, z, black);
  });
  return grid;
}

class Pick {
 public:
  explicit Pick(unsigned seed) : random_(seed) {}
  int operator()(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  std::mt19937 random_;
};

// Noise, blobs and frames of object.
std::vector<std::uint8_t> random_pixels(int width, int height, Pick& pick) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height), pick(0, 1) ? 255 : 0);
  for (int boxes = pick(1, 6); boxes > 0; --boxes) {
    const int left = pick(0, width - 1), right = pick(left, width - 1), top = pick(0, height - 1),
              bottom = pick(top, height - 1);
    const auto value = static_cast<std::uint8_t>(pick(0, 2));
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) pixels[static_cast<std::size_t>(y * width + x)] = value;
  }
  if (pick(0, 4) == 0)
    for (auto& pixel : pixels) pixel = static_cast<std::uint8_t>(pick(0, 3));
  return pixels;
}

TEST(Silhouettes, EveryVoxelIsAsTheTwinSays) {
  const std::vector<Vector> directions = {{0, -1, 0}, {1, 0, 0},  {0, 0, 1},  {0, 0, -1}, {-1, 0, 0},  {0, 1, 0},
                                          {1, 1, 0},  {3, 4, 0},  {3, -4, 0}, {0, 3, 4},  {1, 1, 1},   {1, -2, 2},
                                          {-2, 3, 6}, {12, 0, 5}, {1, 2, 3},  {7, -4, 4}, {-3, -5, -7}};
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Pick pick(seed);
    const int depth = pick(1, 5);
    std::vector<Silhouette> pictures;
    std::vector<TwinView> views;
    for (int count = pick(1, 4); count > 0; --count) {
      TwinView twin{directions[static_cast<std::size_t>(pick(0, 16))], {0, 0, 1}, 0, 0};
      Silhouette s;
      s.width = pick(1, 1 << pick(0, 6));
      s.height = pick(1, 1 << pick(0, 6));
      s.pixels = random_pixels(s.width, s.height, pick);
      // Any length: only the direction counts.
      s.view = Eigen::Vector3d(static_cast<double>(twin.view[0]), static_cast<double>(twin.view[1]),
                               static_cast<double>(twin.view[2])) *
               pick(1, 3);
      if (twin.view[0] == 0 && twin.view[1] == 0) twin.up = {0, 1, 0};
      if (pick(0, 1)) {
        const Vector up = {pick(-3, 3), pick(-3, 3), pick(-3, 3)};
        if (cross(up, twin.view) != Vector{}) {
          twin.up = up;
          s.up = Eigen::Vector3d(static_cast<double>(up[0]), static_cast<double>(up[1]), static_cast<double>(up[2]));
        }
      }
      if (pick(0, 1)) {  // no pixel size: the picture is as wide as the universe
        twin.whole = 1 << depth;
        twin.part = s.width;
      } else {  // fractions with powers of two are doubles
        twin.whole = pick(1, 24);
        twin.part = 1 << pick(0, 4);
        s.pixel_size = static_cast<double>(twin.whole) / static_cast<double>(twin.part);
      }
      pictures.push_back(std::move(s));
      views.push_back(twin);
    }
    const Octree octree = octree_from_silhouettes(pictures, depth, {}, {pick(1, 2), {}});
    ASSERT_EQ(reference::dense(octree), carved(pictures, views, depth));
    ASSERT_EQ(octree, reference::octree(reference::dense(octree)));  // condensed
  }
}

TEST(Silhouettes, ManyPicturesCarveAsTheirIntersection) {
  Pick pick(5);
  std::vector<Silhouette> pictures;
  DenseGrid expected(5);
  for (auto& voxel : expected.voxels) voxel = 1;
  for (int i = 0; i < 150; ++i) {  // more than the 64 bits that nodes carry down
    Silhouette s;
    s.width = s.height = 40;
    s.pixels.assign(1600, 1);
    for (int holes = 0; holes < 2; ++holes) s.pixels[static_cast<std::size_t>(pick(0, 1599))] = 0;
    s.view = Eigen::Vector3d(pick(-9, 9), pick(-9, 9), pick(1, 9));
    s.pixel_size = 1.5;
    const DenseGrid one = reference::dense(octree_from_silhouettes({s}, 5));
    for (std::size_t k = 0; k < one.voxels.size(); ++k) expected.voxels[k] &= one.voxels[k];
    pictures.push_back(std::move(s));
  }
  const DenseGrid all = reference::dense(octree_from_silhouettes(pictures, 5));
  EXPECT_EQ(all, expected);
  EXPECT_GT(std::count(all.voxels.begin(), all.voxels.end(), 1), 1000);
}

TEST(Silhouettes, PicturesAreSeenTheRightWayRound) {
  // An L in the upper left corner: two pixels along the row, three down the column.
  const std::vector<std::uint8_t> letter = {1, 1, 0, 0,  //
                                            1, 0, 0, 0,  //
                                            1, 0, 0, 0,  //
                                            0, 0, 0, 0};
  const auto seen = [&](const Eigen::Vector3d& view) {
    return octree_from_silhouettes({{4, 4, letter, view, {}, {}}}, 2);
  };
  const Octree front = seen({0, -1, 0});  // columns along x, rows down z
  for (int y = 0; y < 4; ++y) {
    EXPECT_TRUE(front.contains(0, y, 3) && front.contains(1, y, 3) && front.contains(0, y, 2) &&
                front.contains(0, y, 1));
    EXPECT_FALSE(front.contains(2, y, 3) || front.contains(1, y, 2) || front.contains(0, y, 0));
  }
  EXPECT_TRUE(seen({1, 0, 0}).contains(2, 1, 3));   // columns along y
  EXPECT_TRUE(seen({-1, 0, 0}).contains(2, 2, 3));  // columns against y
  EXPECT_TRUE(seen({0, 0, 1}).contains(1, 3, 2));   // from the top, y is up
  EXPECT_TRUE(seen({0, 0, -1}).contains(2, 3, 2));  // from below, columns against x
  EXPECT_FALSE(seen({0, 0, -1}).contains(1, 3, 2));
}

TEST(Silhouettes, DoesNotDependOnThreads) {
  Pick pick(3);
  std::vector<Silhouette> pictures;
  for (const Eigen::Vector3d& view : {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0.3, -0.1, 0.7)}) {
    Silhouette s{100, 90, std::vector<std::uint8_t>(9000, 0), view, {}, 1.1};
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 100; ++x)
        s.pixels[static_cast<std::size_t>(y * 100 + x)] = (x - 50) * (x - 50) + (y - 45) * (y - 45) < 1600;
    pictures.push_back(std::move(s));
  }
  const Octree one = octree_from_silhouettes(pictures, 7, {}, {1, {}});
  EXPECT_EQ(one, octree_from_silhouettes(pictures, 7, {}, {2, {}}));
  EXPECT_FALSE(one.is_empty());
}

TEST(Silhouettes, WhatIsWrongIsTold) {
  const Silhouette good{2, 2, {1, 1, 1, 1}, {1, 0, 0}, {}, {}};
  const auto error = [&](const auto& change, int depth = 3) {
    Silhouette bad = good;
    change(bad);
    return error_of(ErrorCode::bad_argument, [&] { octree_from_silhouettes({good, bad}, depth); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error([](Silhouette& s) { s.width = 0; }).find("silhouette 1 has no pixels"), std::string::npos);
  EXPECT_NE(error([](Silhouette& s) { s.height = 3; }).find("4 pixels instead of 6"), std::string::npos);
  EXPECT_NE(error([](Silhouette& s) { s.width = s.height = 1 << 30; }).find("2^30 pixels"), std::string::npos);
  EXPECT_NE(error([](Silhouette& s) { s.view.setZero(); }).find("view that is zero"), std::string::npos);
  EXPECT_NE(error([&](Silhouette& s) { s.view[1] = nan; }).find("not finite"), std::string::npos);
  EXPECT_NE(error([](Silhouette& s) { s.up = Eigen::Vector3d(-2, 0, 0); }).find("parallel"), std::string::npos);
  EXPECT_NE(error([](Silhouette& s) { s.up = Eigen::Vector3d(0, 0, 0); }).find("up that is zero"), std::string::npos);
  for (const double size : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 0x1p31, 0x1p-31})
    EXPECT_NE(error([&](Silhouette& s) { s.pixel_size = size; }).find("pixel size"), std::string::npos);
  EXPECT_NE(error([](Silhouette&) {}, 21).find("depth 21"), std::string::npos);
  EXPECT_NE(error_of(ErrorCode::bad_argument, [] { octree_from_silhouettes({}, 3); }).find("no silhouettes"),
            std::string::npos);
}

// ---- the walls themselves, at sizes that the twin cannot reach

TEST(PixelWalls, ScalingTheAxisChangesNothing) {
  Pick pick(11);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const int bits = pick(1, 18);
    const std::array<std::int64_t, 3> axis = {pick(1, 1 << bits), pick(-(1 << bits), 1 << bits), pick(-3, 3)};
    const std::int64_t factor = std::int64_t{1} + (std::int64_t{pick(0, (1 << 30) - 1)} << pick(0, 12));
    const std::array<std::int64_t, 3> longer = {axis[0] * factor, axis[1] * factor, axis[2] * factor};
    const PixelSize size =
        pick(0, 1) ? PixelSize::of(std::ldexp(pick(1, 1 << 30), pick(-50, -20))) : PixelSize{1, 300, pick(0, 20)};
    const int count = pick(1, 500);
    const PixelWalls walls(axis, count, size), scaled(longer, count, size);
    for (int k = 0; k < 200; ++k) {
      const std::array<std::int32_t, 3> q = {pick(-(1 << 20), 1 << 20), pick(-(1 << 20), 1 << 20),
                                             pick(-(1 << 20), 1 << 20)};
      const Wide place = walls.place(q) >> pick(0, 30);
      ASSERT_EQ(walls.pixel(place), scaled.pixel(place * factor));
      // Between place - 1 and place there is no other place, so walls that are finer must not tell them apart wrongly.
      ASSERT_LE(scaled.pixel(place * factor - 1), walls.pixel(place));
      ASSERT_GE(scaled.pixel(place * factor - 1), walls.pixel(place - 1));
    }
  }
}

TEST(PixelWalls, WallsOnWholePlacesBelongToTheirPixel) {
  // |A| = 5 * 10^8, pixels of 2 voxels: the wall of pixel k lies at (2k - 6) * 10^9 exactly.
  const PixelWalls walls({300'000'000, -400'000'000, 0}, 6, PixelSize::of(2));
  for (int k = 0; k <= 6; ++k) {
    const Wide wall = Wide{2 * k - 6} * 1'000'000'000;
    EXPECT_EQ(walls.pixel(wall), k);
    EXPECT_EQ(walls.pixel(wall - 1), k - 1);
  }
  EXPECT_EQ(walls.pixel(-(Wide{1} << 84)), -1);
  EXPECT_EQ(walls.pixel(Wide{1} << 84), 6);
}

TEST(PixelWalls, PixelSizesAreExact) {
  Pick pick(1);
  for (int i = 0; i < 1000; ++i) {
    const double size = std::ldexp(1.0 + std::ldexp(pick(0, 1 << 30), -30), pick(-30, 29));
    EXPECT_EQ(PixelSize::of(size).value(), size);
  }
  EXPECT_EQ(PixelSize::of(0x1p30).exponent, 30);
  EXPECT_EQ(PixelSize::of(0x1p-30).whole, 1u);
}

}  // namespace
}  // namespace blackleaf
