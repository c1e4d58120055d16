// blackleaf build: octrees of real objects, from meshes, volumes and run streams.
#include "build.h"

#include <fmt/format.h>

#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "commands.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

void declare(CLI::App& app, BuildOptions& o) {
  app.add_option("INPUT", o.input,
                 "mesh (STL, OBJ, PLY, OFF, glTF, 3MF, ...), volume (NRRD, NIfTI, MetaImage, ...) "
                 "or run stream (.runs)")
      ->required()
      ->type_name("");
  add_output(app, o.output, "octree file to write, or - for standard output");
  CLI::Option* depth = add_integer(
      app, "--depth", o.depth, 1, kMaxDepth,
      "1 to 20: the universe has 2^N voxels a side (default: 8 for meshes, else the smallest that holds all)");
  CLI::Option* like =
      add_text(app, "--like", o.like, "FILE.octree", "use the universe of another octree: its depth and frame");
  like->excludes(depth);

  declare_mesh_options(app, o, like);
  declare_volume_options(app, o, like);
  declare_label_options(app, o);
}

Octree from_runs(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  refuse_options(o.input, "a run stream",
                 {{o.depth.has_value(), "--depth"},
                  {o.fit.has_value(), "--fit"},
                  {o.voxel_size.has_value(), "--voxel-size"},
                  {o.rule.has_value(), "--rule"},
                  {o.inside.has_value(), "--inside"},
                  {o.range.has_value(), "--range"},
                  {o.centre, "--centre"}});
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

}  // namespace

Frame frame_for_runs(const BuildOptions& o, const Octree& like, int depth, Json& facts) {
  facts["like"] = base_name(*o.like);
  if (like.depth() != depth)
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' has depth {} and '{}' has depth {}", o.input, depth, *o.like, like.depth()),
                "a run stream fits only universes of its own depth");
  return like.frame();
}

void refuse_options(const std::string& input, const std::string& kind,
                    std::initializer_list<std::pair<bool, const char*>> options) {
  for (const auto& [given, name] : options)
    if (given)
      throw Error(ErrorCode::bad_argument, fmt::format("{} does not apply to '{}', which is {}", name, input, kind),
                  "leave it out");
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
  check_plain_input(o.input, "a mesh, volume or run stream");
  std::optional<Octree> like;
  if (o.like) like = read_octree(session, *o.like).octree;

  Json facts = Json::object();
  if (suffix_of(o.input) == ".octree")
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is an octree already", o.input),
                "use move, combine or export");
  if (o.labels || o.bands) {
    write_labels(session, build_labels(session, o, like, facts), o.output, o.input, facts);
    return kDone;
  }
  Octree octree;
  if (suffix_of(o.input) == ".runs")
    octree = from_runs(session, o, like, facts);
  else if (is_volume_name(o.input))
    octree = build_volume(session, o, like, facts);
  else
    octree = build_mesh(session, o, like, facts);
  warn_if_empty(session, octree);
  write_octree(session, octree, o.output, o.input, facts);
  return kDone;
}

}  // namespace blackleaf::cli
