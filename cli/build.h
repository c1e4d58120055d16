// blackleaf build: what its kinds of input share. Each kind has a file of its own: build_mesh.cpp, build_volume.cpp,
// ...
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/octree.h"
#include "session.h"

namespace blackleaf::cli {

struct BuildOptions {
  std::string input, output;
  std::optional<int> depth;
  std::optional<double> fit, voxel_size, label;
  std::optional<std::string> rule, inside, range, like;
  bool centre = false;
  bool labels = false;
  std::optional<std::string> bands;
};

/// One kind of input: declares the options that only it has, and builds. `like` is the octree that --like names; what
/// was chosen is added to `facts`, which go into the file's metadata.
void declare_mesh_options(CLI::App& app, BuildOptions& options, CLI::Option* like);
Octree build_mesh(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
void declare_volume_options(CLI::App& app, BuildOptions& options, CLI::Option* like);
Octree build_volume(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);

/// Label maps, from volumes and run streams: --labels and --bands.
void declare_label_options(CLI::App& app, BuildOptions& options);
LabelMap build_labels(Session& session, const BuildOptions& options, const std::optional<Octree>& like, Json& facts);
/// The universe of --like for a run stream of this depth: throws if its depth is another. Notes it in `facts`.
Frame frame_for_runs(const BuildOptions& options, const Octree& like, int depth, Json& facts);

/// Throws if an option was given that means nothing for this kind of input.
void refuse_options(const std::string& input, const std::string& kind,
                    std::initializer_list<std::pair<bool, const char*>> options);

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
