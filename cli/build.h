// blackleaf build: what its kinds of input share. Each kind has a file of its own: build_mesh.cpp, build_volume.cpp,
// ...
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/octree.h"
#include "blackleaf/volume_file.h"
#include "session.h"

namespace blackleaf::cli {

struct BuildOptions {
  std::string input, output;
  std::optional<int> depth, min_points;
  std::optional<double> fit, voxel_size, label;
  std::optional<std::string> rule, inside, range, like, series;
  std::optional<std::array<double, 3>> spacing;
  bool centre = false, clip = false, points = false;
  bool labels = false;
  std::optional<std::string> bands;
};

/// One kind of input: declares the options that only it has, and builds. `like` is the octree that --like names; what
/// was chosen is added to `facts`, which go into the file's metadata.
void declare_mesh_options(App& app, BuildOptions& options, Option* like);
Octree build_mesh(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
void declare_volume_options(App& app, BuildOptions& options, Option* like);
/// The options for volumes, into the library's; notes them in `facts`.
VolumeOptions volume_options(const Session& session, const BuildOptions& options, const std::optional<Octree>& like,
                             Json& facts);
Octree build_volume(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
void declare_points_options(App& app, BuildOptions& options);
Octree build_points(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
Octree build_silhouettes(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);

/// Label maps, from volumes and run streams: --labels and --bands.
void declare_label_options(App& app, BuildOptions& options);
LabelMap build_labels(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
/// The universe of --like for a run stream of this depth: throws if its depth is another. Notes it in `facts`.
Frame frame_for_runs(const BuildOptions& options, const Octree& like, int depth, Json& facts);

/// The options that all volumes share, into VolumeOptions or LabelVolumeOptions.
template <class Options>
void take_volume_options(const Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts,
                         Options& options) {
  if (o.series) {
    if (o.series->empty())
      throw Error(ErrorCode::bad_argument, "--series is empty", "give the UID of a series, or how it ends");
    options.series = *o.series;
    facts["series"] = *o.series;
  }
  options.spacing = o.spacing;
  if (o.spacing) facts["spacing"] = *o.spacing;
  options.warn = [&session](const std::string& what) { session.warn(what); };
  options.depth = like ? like->depth() : o.depth.value_or(0);
  options.centre = o.centre;
  if (o.centre) facts["centre"] = true;
}

/// What the function returns; its errors begin with the file's name.
template <class Function>
auto naming(const std::string& file, Function&& function) {
  try {
    return std::forward<Function>(function)();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    throw Error(error.code(), file + ": " + error.what());
  }
}

}  // namespace blackleaf::cli
