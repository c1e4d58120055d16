// blackleaf build: octrees of real objects, from meshes, volumes and run streams.
#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "blackleaf/mesh_file.h"
#include "blackleaf/move.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "commands.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

struct BuildOptions {
  std::string input, output;
  std::optional<int> depth;
  std::optional<double> fit, voxel_size, label;
  std::optional<std::string> rule, range, like;
  bool centre = false;
};

constexpr int kMeshDepth = 8;
constexpr double kMeshFit = 0.75;

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

  const std::string meshes = "Options for meshes";
  CLI::Option* fit =
      add_number(app, "--fit", o.fit, true,
                 "longest side as a fraction of the universe, above 0, at most 1 (default 0.75); centred");
  CLI::Option* size = add_number(app, "--voxel-size", o.voxel_size, true, "side of a voxel in the mesh's units");
  fit->group(meshes)->excludes(size)->excludes(like);
  size->group(meshes)->excludes(like);
  add_text(app, "--rule", o.rule, "RULE",
           "centre: a voxel is black iff its centre is inside (default); touched: iff it meets the solid at all")
      ->group(meshes);

  const std::string volumes = "Options for volumes";
  CLI::Option* range = add_text(app, "--range", o.range, "LO:HI",
                                "values inside, ends included; either may be empty (default: any value above 0)");
  CLI::Option* label = app.add_option_function<std::string>(
                              "--label", [&o](const std::string& text) { o.label = parse_number("--label", text); },
                              "exactly this value is inside")
                           ->type_name("L");
  range->group(volumes)->excludes(label);
  label->group(volumes);
  app.add_flag("--centre", o.centre, "centre the volume in the universe instead of placing it at the corner")
      ->group(volumes)
      ->excludes(like);
}

// Throws if an option was given that means nothing for this kind of input.
void refuse_options(const std::string& input, const std::string& kind,
                    std::initializer_list<std::pair<bool, const char*>> options) {
  for (const auto& [given, name] : options)
    if (given)
      throw Error(ErrorCode::bad_argument, fmt::format("{} does not apply to '{}', which is {}", name, input, kind),
                  "leave it out");
}

// The octree in another universe, when the two differ by a shift of whole voxels.
Octree placed_in(const Octree& octree, const Octree& universe, const std::string& input, const std::string& like) {
  const Frame& from = octree.frame();
  const Frame& to = universe.frame();
  const Eigen::Vector3d corner = to.axes.fullPivLu().solve(from.origin - to.origin);
  const Eigen::Vector3d whole = corner.array().round();
  // Geometry in file headers is rounded; what is left of a voxel after that must be far below one.
  constexpr double kTolerance = 1e-3;
  const bool fits = (corner - whole).cwiseAbs().maxCoeff() <= kTolerance && whole.cwiseAbs().maxCoeff() < 0x1p40 &&
                    Frame{to.origin, from.axes, from.unit}.same_as(to);
  if (!fits)
    throw Error(ErrorCode::bad_input,
                fmt::format("the voxels of '{}' are not those of '{}' shifted by whole voxels", input, like),
                "leave --like out, or resample the volume");
  const std::array<std::int64_t, 3> by = {std::llround(whole[0]), std::llround(whole[1]), std::llround(whole[2])};
  return translate(octree, by).with_frame(to);
}

// What the function returns; its errors begin with the file's name.
template <class Function>
auto naming(const std::string& file, Function&& function) {
  try {
    return std::forward<Function>(function)();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    throw Error(error.code(), file + ": " + error.what());
  }
}

// What is neither a volume nor a run stream by its suffix is read as a mesh. If it cannot be one by its suffix either,
// the message lists all that could have been meant.
TriangleMesh read_as_mesh(const std::string& input) {
  constexpr std::array<const char*, 7> kMeshes = {".stl", ".obj", ".ply", ".off", ".gltf", ".glb", ".3mf"};
  try {
    return read_mesh(input);
  } catch (const Error& error) {
    const bool known = std::find(kMeshes.begin(), kMeshes.end(), suffix_of(input)) != kMeshes.end();
    const std::string what = error.what();
    if (known || error.code() != ErrorCode::bad_input) throw;
    throw Error(
        error.code(), what.substr(0, what.find("; use ")),
        "use a mesh (STL, OBJ, PLY, OFF, glTF, 3MF), a volume (NRRD, NIfTI, MetaImage) or a run stream (.runs)");
  }
}

Octree from_mesh(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  refuse_options(o.input, "a mesh",
                 {{o.range.has_value(), "--range"}, {o.label.has_value(), "--label"}, {o.centre, "--centre"}});
  const std::string rule = o.rule.value_or("centre");
  if (rule != "centre" && rule != "touched")
    throw Error(ErrorCode::bad_argument, fmt::format("--rule is '{}', which is unknown", rule),
                "use centre or touched");
  if (o.fit && *o.fit > 1)
    throw Error(ErrorCode::bad_argument, fmt::format("--fit is {}, which is more than the universe", *o.fit),
                "give a fraction above 0 and at most 1");

  // Smaller than any voxel of any universe.
  if (o.fit && *o.fit < 0x1p-24)
    throw Error(ErrorCode::bad_argument, fmt::format("--fit is {}, which is less than any voxel", *o.fit),
                "give a fraction above 0 and at most 1, like 0.75");

  const TriangleMesh mesh = session.stage("read", [&](const Work&) { return read_as_mesh(o.input); });
  MeshPlacement placement;
  if (like) {
    placement = {like->depth(), like->frame()};
    facts["like"] = base_name(*o.like);
  } else if (o.voxel_size) {
    placement = naming(o.input, [&] { return place_by_voxel_size(mesh, *o.voxel_size, o.depth.value_or(0)); });
    facts["voxel_size"] = *o.voxel_size;
  } else {
    placement = naming(o.input,
                       [&] { return place_by_fraction(mesh, o.depth.value_or(kMeshDepth), o.fit.value_or(kMeshFit)); });
    facts["fit"] = o.fit.value_or(kMeshFit);
  }
  facts["depth"] = placement.depth;
  facts["rule"] = rule;
  return session.stage("build", [&](const Work& work) {
    const MeshRule mesh_rule = rule == "centre" ? MeshRule::centre : MeshRule::touched;
    return naming(o.input, [&] { return octree_from_mesh(mesh, placement, mesh_rule, work); });
  });
}

Octree from_volume(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  refuse_options(
      o.input, "a volume",
      {{o.fit.has_value(), "--fit"}, {o.voxel_size.has_value(), "--voxel-size"}, {o.rule.has_value(), "--rule"}});
  VolumeOptions options;
  if (o.range) {
    const Range range = parse_range("--range", *o.range);
    options.low = range.low;
    options.high = range.high;
    facts["range"] = *o.range;
  }
  options.label = o.label;
  if (o.label) facts["label"] = *o.label;
  options.depth = like ? like->depth() : o.depth.value_or(0);
  options.centre = o.centre;
  if (o.centre) facts["centre"] = true;
  if (like) facts["like"] = base_name(*o.like);
  // The volume is built while it is read, so this is one stage.
  Octree octree = session.stage("build", [&](const Work& work) { return read_volume(o.input, options, work); });
  facts["depth"] = octree.depth();
  if (like) octree = placed_in(octree, *like, o.input, *o.like);
  return octree;
}

Octree from_runs(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  refuse_options(o.input, "a run stream",
                 {{o.depth.has_value(), "--depth"},
                  {o.fit.has_value(), "--fit"},
                  {o.voxel_size.has_value(), "--voxel-size"},
                  {o.rule.has_value(), "--rule"},
                  {o.range.has_value(), "--range"},
                  {o.label.has_value(), "--label"},
                  {o.centre, "--centre"}});
  Octree octree = session.stage("build", [&](const Work&) { return read_runs(o.input); });
  facts["depth"] = octree.depth();
  if (!like) return octree;
  facts["like"] = base_name(*o.like);
  if (like->depth() != octree.depth())
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' has depth {} and '{}' has depth {}", o.input, octree.depth(), *o.like, like->depth()),
                "a run stream fits only universes of its own depth");
  return octree.with_frame(like->frame());
}

}  // namespace

int run_build(Session& session) {
  BuildOptions o;
  declare(session.app(), o);
  session.add_json();
  session.set_example(
      "blackleaf build bunny.stl -o bunny.octree --depth 9\n"
      "  blackleaf build head.nii.gz -o bone.octree --range 300:");
  if (!session.parse()) return kDone;

  check_octree_output(session, o.output);
  if (o.input == "-") throw Error(ErrorCode::bad_argument, "standard input cannot be built from", "name a file");
  check_plain_input(o.input, "a mesh, volume or run stream");
  std::optional<Octree> like;
  if (o.like) like = read_octree(session, *o.like).octree;

  Json facts = Json::object();
  Octree octree;
  if (suffix_of(o.input) == ".octree")
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is an octree already", o.input),
                "use move, combine or export");
  if (suffix_of(o.input) == ".runs")
    octree = from_runs(session, o, like, facts);
  else if (is_volume_name(o.input))
    octree = from_volume(session, o, like, facts);
  else
    octree = from_mesh(session, o, like, facts);
  warn_if_empty(session, octree);
  write_octree(session, octree, o.output, o.input, facts);
  return kDone;
}

}  // namespace blackleaf::cli
