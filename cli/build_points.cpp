// blackleaf build: point clouds.
#include <fmt/format.h>

#include <limits>

#include "blackleaf/points.h"
#include "blackleaf/points_file.h"
#include "build.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

constexpr int kPointsDepth = 8;
constexpr double kPointsFit = 0.75;

}  // namespace

void declare_points_options(App& app, BuildOptions& o) {
  const std::string points = "Options for point clouds";
  add_integer(app, "--min-points", o.min_points, 1, std::numeric_limits<int>::max(),
              "a voxel is black iff it holds at least N points (default 1)")
      ->group(points);
  app.add_flag("--clip", o.clip, "drop points outside the universe instead of refusing them")->group(points);
  app.add_flag("--points", o.points, "take the vertices of a mesh as points")->group(points);
}

Octree build_points(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  MeshPlacement placement;
  if (like) {
    placement = {like->depth(), like->frame()};
    facts["like"] = base_name(*o.like);
  } else {
    // Read once to see where the points lie and once to put them into voxels: they need not fit into memory.
    const PointsInfo info = session.stage("read", [&](const Work& work) {
      return read_points(
          o.input, [](std::span<const Eigen::Vector3d>) {}, work);
    });
    placement = naming(o.input, [&] {
      if (o.voxel_size) return place_points_by_voxel_size(info.box, *o.voxel_size, o.depth.value_or(0));
      return place_points_by_fraction(info.box, o.depth.value_or(kPointsDepth), o.fit.value_or(kPointsFit));
    });
    if (o.voxel_size)
      facts["voxel_size"] = *o.voxel_size;
    else
      facts["fit"] = o.fit.value_or(kPointsFit);
  }
  PointOptions options;
  options.min_points = static_cast<std::uint64_t>(o.min_points.value_or(1));
  options.clip = o.clip;
  facts["depth"] = placement.depth;
  facts["min_points"] = options.min_points;
  if (o.clip) facts["clip"] = true;
  if (o.points) facts["points"] = true;

  PointGatherer gatherer = session.stage("build", [&](const Work& work) {
    PointGatherer gathered(placement, options, work.threads);
    read_points(
        o.input, [&](std::span<const Eigen::Vector3d> points) { gathered.add(points); }, work);
    return gathered;
  });
  Octree octree =
      session.stage("build", [&](const Work& work) { return naming(o.input, [&] { return gatherer.octree(work); }); });
  if (gatherer.not_finite() > 0)
    session.warn(fmt::format("{} of {} have a coordinate that is not a number and were dropped",
                             grouped(gatherer.not_finite()), counted(gatherer.points(), "point")));
  if (gatherer.outside() > 0)
    session.warn(fmt::format("{} of {} lie outside the universe and were clipped", grouped(gatherer.outside()),
                             counted(gatherer.points(), "point")));
  return octree;
}

}  // namespace blackleaf::cli
