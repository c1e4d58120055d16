// blackleaf build: triangle meshes.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "blackleaf/mesh.h"
#include "blackleaf/mesh_file.h"
#include "build.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

constexpr int kMeshDepth = 8;
constexpr double kMeshFit = 0.75;

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
        "use a mesh (STL, OBJ, PLY, OFF, glTF, 3MF), a point cloud (PLY, PCD, XYZ), silhouettes (.json, .toml), "
        "a volume (NRRD, NIfTI, MetaImage, DICOM, TIFF, PNG) or a run stream (.runs)");
  }
}

}  // namespace

void declare_mesh_options(CLI::App& app, BuildOptions& o, CLI::Option* like) {
  const std::string meshes = "Options for meshes", both = "Options for meshes and point clouds";
  CLI::Option* fit =
      add_number(app, "--fit", o.fit, true,
                 "longest side as a fraction of the universe, above 0, at most 1 (default 0.75); centred");
  CLI::Option* size = add_number(app, "--voxel-size", o.voxel_size, true, "side of a voxel in the input's units");
  fit->group(both)->excludes(size)->excludes(like);
  size->group(both)->excludes(like);
  add_text(app, "--rule", o.rule, "RULE",
           "centre: a voxel is black iff its centre is inside (default); touched: iff it meets the solid at all")
      ->group(meshes);
}

Octree build_mesh(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  refuse_options(o.input, "a mesh",
                 {{o.range.has_value(), "--range"},
                  {o.label.has_value(), "--label"},
                  {o.series.has_value(), "--series"},
                  {o.spacing.has_value(), "--spacing"},
                  {o.centre, "--centre"}});
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

}  // namespace blackleaf::cli
