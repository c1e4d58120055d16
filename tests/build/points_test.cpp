#include "blackleaf/points.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "blackleaf/error.h"
#include "meshes.h"
#include "reference/dense_grid.h"

namespace blackleaf {
namespace {

using reference::DenseGrid;
using testing::error_of;
using Points = std::vector<Eigen::Vector3d>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Pick {
 public:
  explicit Pick(unsigned seed) : random_(seed) {}
  int operator()(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937 random_;
};

// The twin: voxels as a map from coordinates to counts. Points are given in voxels.
DenseGrid occupied(const Points& voxels, int depth, std::uint64_t min_points) {
  std::map<std::array<int, 3>, std::uint64_t> counts;
  const int side = 1 << depth;
  for (const Eigen::Vector3d& p : voxels) {
    if (!p.allFinite() || p.minCoeff() < 0 || p.maxCoeff() > side) continue;
    std::array<int, 3> voxel{};
    for (int i = 0; i < 3; ++i)
      voxel[static_cast<std::size_t>(i)] = std::min(static_cast<int>(std::floor(p[i])), side - 1);
    ++counts[voxel];
  }
  DenseGrid grid(depth);
  for (const auto& [voxel, count] : counts)
    if (count >= min_points) grid.set(voxel[0], voxel[1], voxel[2]);
  return grid;
}

TEST(Points, EveryVoxelIsAsTheTwinSays) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Pick pick(seed);
    const int depth = pick(1, 5), side = 1 << depth;
    // A frame that keeps quarters of voxels exact: they fall on walls, edges and corners.
    MeshPlacement placement{depth, {}};
    placement.frame.axes.diagonal() = Eigen::Vector3d(0.5, -2, 4);
    placement.frame.origin = Eigen::Vector3d(pick(-5, 5), pick(-5, 5), pick(-5, 5));
    if (pick(0, 1)) placement.frame.axes.row(0).swap(placement.frame.axes.row(2));
    Points voxels, world;
    for (int count = pick(0, 1 << pick(0, 12)); count > 0; --count) {
      Eigen::Vector3d p;
      for (int i = 0; i < 3; ++i) p[i] = pick(0, 4 * side) / 4.0;
      if (pick(0, 30) == 0) p[pick(0, 2)] = kNaN;
      if (pick(0, 30) == 0) p[pick(0, 2)] = pick(0, 1) ? -0.25 : side + 0.25;
      voxels.push_back(p);
      world.push_back(placement.frame.to_world(p));
    }
    const PointOptions options{static_cast<std::uint64_t>(pick(1, 4)), true};
    PointGatherer gatherer(placement, options, pick(1, 2));
    for (std::size_t begin = 0; begin < world.size();) {  // in pieces, with answers in between
      const auto size = std::min(world.size() - begin, static_cast<std::size_t>(pick(1, 700)));
      gatherer.add(std::span(world).subspan(begin, size));
      begin += size;
      if (pick(0, 3) == 0) gatherer.octree();
    }
    const Octree octree = gatherer.octree({pick(1, 2), {}});
    ASSERT_EQ(reference::dense(octree), occupied(voxels, depth, options.min_points));
    ASSERT_EQ(octree, reference::octree(reference::dense(octree)));  // condensed
    ASSERT_EQ(octree.frame(), placement.frame);
    ASSERT_EQ(gatherer.points(), world.size());
    ASSERT_EQ(gatherer.not_finite(),
              std::count_if(voxels.begin(), voxels.end(), [](const Eigen::Vector3d& p) { return !p.allFinite(); }));
    ASSERT_EQ(gatherer.outside(), std::count_if(voxels.begin(), voxels.end(), [&](const Eigen::Vector3d& p) {
                return p.allFinite() && (p.minCoeff() < 0 || p.maxCoeff() > side);
              }));
  }
}

TEST(Points, FullNodesAreCondensed) {
  Points points;
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  EXPECT_EQ(octree_from_points(points, {4, {}}), Octree(4, Colour::black));
  EXPECT_EQ(octree_from_points(points, {6, {}}), box(6, {0, 0, 0}, {16, 16, 16}));
  EXPECT_TRUE(octree_from_points(points, {6, {}}, {2, false}).is_empty());
}

TEST(Points, DeepUniversesAndTheirCorners) {
  const double last = (1 << 20) - 1;
  const Points points = {
      {0, 0, 0}, {last + 1, last + 1, last + 1}, {last, 0.999, 1}, {last + 1 + 0x1p-17, -0x1p-17, 7}};
  const Octree octree = octree_from_points(points, {20, {}});
  const auto edge = (1 << 20) - 1;
  EXPECT_TRUE(octree.contains(0, 0, 0) && octree.contains(edge, edge, edge) && octree.contains(edge, 0, 1) &&
              octree.contains(edge, 0, 7));
  Points one = {{0.5, 0.5, 0.5}};
  EXPECT_TRUE(octree_from_points(one, {1, {}}).contains(0, 0, 0));
  EXPECT_FALSE(octree_from_points(one, {1, {}}).contains(1, 0, 0));
  EXPECT_TRUE(octree_from_points({}, {3, {}}).is_empty());
}

TEST(Points, MoreThanAreHeldBackAtOnce) {
  // Beyond the 2^22 points that wait to be sorted, so that merging is seen; every voxel of a line gets its share.
  Points whole;
  for (int i = 0; i < 1 << 16; ++i) whole.emplace_back(i % 1024 + 0.5, 3.5, 700.5);
  std::vector<Octree> results;
  for (const int threads : {1, 2}) {
    PointGatherer gatherer({10, {}}, {64 * 70, false}, threads);
    Points piece = whole;
    for (int i = 0; i < 70; ++i) {
      if (i == 69) piece.resize(1000);  // the last 24 voxels get one point less
      gatherer.add(piece);
      if (i == 69)
        for (int k = 1; k < 64; ++k) gatherer.add(piece);
    }
    EXPECT_EQ(gatherer.points(), 69u * 65536 + 64000);
    results.push_back(gatherer.octree());
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], box(10, {0, 3, 700}, {1000, 4, 701}));
}

TEST(Points, OutsideIsRefusedUnlessClipped) {
  const Points points = {{1, 1, 1}, {9, 1, 1}, {-1, 0, 0}};
  const std::string error = error_of(ErrorCode::out_of_universe, [&] { octree_from_points(points, {3, {}}); });
  EXPECT_NE(error.find("2 of 3 points lie outside the universe, the first at (9"), std::string::npos) << error;
  EXPECT_EQ(octree_from_points(points, {3, {}}, {1, true}), box(3, {1, 1, 1}, {2, 2, 2}));
  const Points far = {{1e300, -1e300, 1}, {1e308, 1e308, 1e308}};
  EXPECT_TRUE(octree_from_points(far, {3, {{}, Eigen::Matrix3d::Identity() * 1e-100, "m"}}, {1, true}).is_empty());
}

TEST(Points, WhatIsWrongIsTold) {
  const auto error = [](const auto& call) { return error_of(ErrorCode::bad_argument, call); };
  EXPECT_NE(error([] { PointGatherer({0, {}}); }).find("depth 0"), std::string::npos);
  EXPECT_NE(error([] { PointGatherer({21, {}}); }).find("depth 21"), std::string::npos);
  EXPECT_NE(error([] { PointGatherer({3, {}}, {0, false}); }).find("0 points a voxel"), std::string::npos);
  EXPECT_NE(error([] { PointGatherer({3, {{}, Eigen::Matrix3d::Zero(), ""}}); }).find("axes"), std::string::npos);
}

// ---- placements

Eigen::AlignedBox3d box_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  return box;
}

TEST(PointPlacement, ByFractionIsCentred) {
  const MeshPlacement placement = place_points_by_fraction(box_of({{1, 1, 1}, {5, 3, 2}}), 4, 0.5);
  EXPECT_EQ(placement.depth, 4);
  EXPECT_EQ(placement.frame.axes, Eigen::Matrix3d::Identity() * 0.5);
  EXPECT_EQ(placement.frame.to_world({8, 8, 8}), Eigen::Vector3d(3, 2, 1.5));
}

TEST(PointPlacement, ByVoxelSizeLiesOnTheLatticeOfAllClouds) {
  Pick pick(4);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const double size = pick(0, 1) ? 0.05 : pick.real(0.01, 3);
    Points points;
    for (int count = pick(1, 50); count > 0; --count)
      points.emplace_back(pick.real(-9, 9), pick.real(-1, 20), pick.real(100, 101));
    const MeshPlacement placement = place_points_by_voxel_size(box_of(points), size);
    for (int axis = 0; axis < 3; ++axis) {
      const double place = placement.frame.origin[axis] / size;
      EXPECT_NEAR(place, std::round(place), 1e-9);
    }
    // Every point is in the voxel of its own quotients, as OctoMap counts them, and one voxel less would not do.
    const Octree octree = octree_from_points(points, placement);
    std::set<std::array<std::int64_t, 3>> expected;
    const Eigen::Vector3d corner = (placement.frame.origin / size).array().round();
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d voxel = (p / size).array().floor() - corner.array();
      expected.insert({std::llround(voxel[0]), std::llround(voxel[1]), std::llround(voxel[2])});
    }
    EXPECT_EQ(measure(octree).volume, expected.size());
    for (const auto& v : expected) EXPECT_TRUE(octree.contains(v[0], v[1], v[2]));
    if (placement.depth > 1) {
      EXPECT_NE(error_of(ErrorCode::out_of_universe,
                         [&] { place_points_by_voxel_size(box_of(points), size, placement.depth - 1); }),
                "");
    }
  }
}

TEST(PointPlacement, PointsOnWallsBelongToTheUpperVoxel) {
  // 0.3 / 0.1 is less than 3 in doubles; rounded to the grid it is the wall.
  const Points points = {{-0.3, 0, 0.3}, {0.7, 0.1, 0.6}};
  const MeshPlacement placement = place_points_by_voxel_size(box_of(points), 0.1);
  EXPECT_EQ(placement.depth, 4);
  const Octree octree = octree_from_points(points, placement);
  const Eigen::Vector3d corner = (placement.frame.origin / 0.1).array().round();
  EXPECT_TRUE(octree.contains(-3 - std::lround(corner[0]), -std::lround(corner[1]), 3 - std::lround(corner[2])));
  EXPECT_TRUE(octree.contains(7 - std::lround(corner[0]), 1 - std::lround(corner[1]), 6 - std::lround(corner[2])));
}

TEST(PointPlacement, WhatIsWrongIsTold) {
  const auto cloud = box_of({{0, 0, 0}, {1, 2, 3}});
  const auto input = [](const auto& call) { return error_of(ErrorCode::bad_input, call); };
  const auto argument = [](const auto& call) { return error_of(ErrorCode::bad_argument, call); };
  EXPECT_NE(input([] { place_points_by_fraction({}, 3, 0.5); }).find("no points"), std::string::npos);
  EXPECT_NE(input([] { place_points_by_voxel_size({}, 1); }).find("no points"), std::string::npos);
  EXPECT_NE(input([] { place_points_by_fraction(box_of({{1, 1, 1}}), 3, 0.5); }).find("one place"), std::string::npos);
  EXPECT_EQ(place_points_by_voxel_size(box_of({{1, 1, 1}}), 2).depth, 1);  // one place is enough here
  EXPECT_NE(input([] {
              place_points_by_voxel_size(box_of({{1e30, 0, 0}, {1e30, 1, 1}}), 1);
            }).find("2^50 voxels or more from the origin"),
            std::string::npos);
  EXPECT_NE(error_of(ErrorCode::out_of_universe,
                     [] {
                       place_points_by_voxel_size(box_of({{0, 0, 0}, {1e30, 1, 1}}), 1);
                     })
                .find("span 2^50 voxels or more"),
            std::string::npos);
  EXPECT_NE(input([] {
              place_points_by_fraction(box_of({{-1e308, 0, 0}, {1e308, 1, 1}}), 3, 0.5);
            }).find("too far"),
            std::string::npos);
  for (const double bad : {0.0, -1.0, kNaN, kInfinity}) {
    EXPECT_NE(argument([&] { place_points_by_fraction(cloud, 3, bad); }), "");
    EXPECT_NE(argument([&] { place_points_by_voxel_size(cloud, bad); }), "");
  }
  EXPECT_NE(argument([&] { place_points_by_fraction(cloud, 3, 1.5); }), "");
  EXPECT_NE(argument([&] { place_points_by_fraction(cloud, 0, 0.5); }), "");
  EXPECT_NE(argument([&] { place_points_by_voxel_size(cloud, 1, 21); }), "");
  EXPECT_NE(error_of(ErrorCode::out_of_universe, [&] { place_points_by_voxel_size(cloud, 1e-7); }).find("depth 20"),
            std::string::npos);
}

}  // namespace
}  // namespace blackleaf
