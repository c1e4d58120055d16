// blackleaf build: octrees of real objects, from meshes, volumes, point clouds, silhouettes and run streams.
#include "build.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "blackleaf/points_file.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "commands.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

void declare(App& app, BuildOptions& o) {
  app.add_option("INPUT", o.input,
                 "mesh (STL, OBJ, PLY, OFF, glTF, 3MF, ...), volume (NRRD, NIfTI, MetaImage, DICOM, TIFF, PNG, or a "
                 "folder of slices), point cloud (PLY, PCD, XYZ, ...), silhouettes (.json or .toml naming PNG images) "
                 "or run stream (.runs)")
      ->required()
      ->type_name("");
  add_output(app, o.output, "octree file to write, or - for standard output");
  Option* depth = add_integer(app, "--depth", o.depth, 1, kMaxDepth,
                              "1 to 20: the universe has 2^N voxels a side (default: 8 for meshes and points, "
                              "else the smallest that holds all)");
  Option* like =
      add_text(app, "--like", o.like, "FILE.octree", "use the universe of another octree: its depth and frame");
  like->excludes(depth);

  declare_mesh_options(app, o, like);
  declare_points_options(app, o);
  declare_volume_options(app, o, like);
  declare_label_options(app, o);
}

Octree from_runs(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  Octree octree = session.stage("build", [&](const Work&) {
    if (!o.label) return read_runs(o.input);
    // A label that is no whole number is that of no voxel.
    const LabelMap labels = read_label_runs(o.input);
    return octree_from_labels(labels, [&](std::uint32_t label) { return static_cast<double>(label) == *o.label; });
  });
  facts["depth"] = octree.depth();
  if (o.label) facts["label"] = *o.label;
  return like ? octree.with_frame(frame_for_runs(o, *like, octree.depth(), facts)) : octree;
}

enum class Kind { mesh, points, silhouettes, volume, runs };

// What INPUT is: by its name, and for PLY files and folders by what is in them. What is nothing else is read as a mesh.
Kind kind_of(const BuildOptions& o) {
  const std::string suffix = suffix_of(o.input);
  if (suffix == ".runs") return Kind::runs;
  if (suffix == ".json" || suffix == ".toml") return Kind::silhouettes;
  if (is_volume(o.input)) return Kind::volume;
  return o.points || is_point_cloud(o.input) ? Kind::points : Kind::mesh;
}

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::mesh:
      return "a mesh";
    case Kind::points:
      return "a point cloud";
    case Kind::silhouettes:
      return "a list of silhouettes";
    case Kind::volume:
      return "a volume";
    case Kind::runs:
      return "a run stream";
  }
  return "";
}

// Throws if an option was given that means nothing for this kind of input.
void refuse_options(const BuildOptions& o, Kind kind) {
  struct Option {
    const char* name;
    bool given;
    std::initializer_list<Kind> kinds;  // that it is for
  };
  using enum Kind;
  const std::initializer_list<Option> options = {
      {"--depth", o.depth.has_value(), {mesh, points, silhouettes, volume}},
      {"--fit", o.fit.has_value(), {mesh, points}},
      {"--voxel-size", o.voxel_size.has_value(), {mesh, points}},
      {"--rule", o.rule.has_value(), {mesh}},
      {"--inside", o.inside.has_value(), {mesh}},
      {"--points", o.points, {points}},
      {"--min-points", o.min_points.has_value(), {points}},
      {"--clip", o.clip, {points}},
      {"--range", o.range.has_value(), {volume}},
      {"--label", o.label.has_value(), {volume, runs}},
      {"--labels", o.labels, {volume, runs}},
      {"--bands", o.bands.has_value(), {volume}},
      {"--series", o.series.has_value(), {volume}},
      {"--spacing", o.spacing.has_value(), {volume}},
      {"--centre", o.centre, {volume}},
  };
  for (const Option& option : options)
    if (option.given && std::find(option.kinds.begin(), option.kinds.end(), kind) == option.kinds.end())
      throw Error(ErrorCode::bad_argument,
                  fmt::format("{} does not apply to '{}', which is {}", option.name, o.input, name_of(kind)),
                  "leave it out");
  if (o.clip && !o.like)
    throw Error(ErrorCode::bad_argument, "--clip is given without --like, but only then can points lie outside",
                "leave it out");
}

}  // namespace

Frame frame_for_runs(const BuildOptions& o, const Octree& like, int depth, Json& facts) {
  facts["like"] = base_name(*o.like);
  if (like.depth() != depth)
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' has depth {} and '{}' has depth {}", o.input, depth, *o.like, like.depth()),
                "a run stream fits only universes of its own depth");
  return like.frame();
}

int run_build(Session& session) {
  BuildOptions o;
  declare(session.app(), o);
  session.add_json();
  session.set_example(
      "blackleaf build bunny.stl -o bunny.octree --depth 9\n"
      "  blackleaf build head.nii.gz -o bone.octree --range 300:\n"
      "  blackleaf build atlas.nii.gz -o atlas.octree --labels");
  if (!session.parse()) return kDone;

  check_octree_output(session, o.output);
  if (o.input == "-") throw Error(ErrorCode::bad_argument, "standard input cannot be built from", "name a file");
  check_input_or_folder(o.input, "a mesh, volume, point cloud, list of silhouettes or run stream");
  std::optional<Octree> like;
  if (o.like) like = read_octree(session, *o.like).octree;

  Json facts = Json::object();
  if (suffix_of(o.input) == ".octree")
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is an octree already", o.input),
                "use move, combine or export");
  const Kind kind = kind_of(o);
  refuse_options(o, kind);
  if (o.labels || o.bands) {
    write_labels(session, build_labels(session, o, like, facts), o.output, o.input, facts);
    return kDone;
  }
  const auto build = [&] {
    switch (kind) {
      case Kind::points:
        return build_points(session, o, like, facts);
      case Kind::silhouettes:
        return build_silhouettes(session, o, like, facts);
      case Kind::volume:
        return build_volume(session, o, like, facts);
      case Kind::runs:
        return from_runs(session, o, like, facts);
      case Kind::mesh:
        break;
    }
    return build_mesh(session, o, like, facts);
  };
  const Octree octree = build();
  warn_if_empty(session, octree);
  write_octree(session, octree, o.output, o.input, facts);
  return kDone;
}

}  // namespace blackleaf::cli
