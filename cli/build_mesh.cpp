// blackleaf build: triangle meshes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

std::string count(std::uint64_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

// What is wrong with the mesh and what was made of it, on one line; "" for a sound one.
std::string faults(const MeshSolid& solid) {
  std::vector<std::string> found;
  const MeshReport& report = solid.found;
  if (const std::uint64_t open = report.open_edges - report.doubled_edges)
    found.push_back(count(open, "open edge", "open edges"));
  if (const std::uint64_t between = report.misoriented_edges - report.open_edges)
    found.push_back(
        count(between, "edge whose triangles face different ways", "edges whose triangles face different ways"));
  if (solid.one_sided_parts > 0) found.push_back(count(solid.one_sided_parts, "one-sided part", "one-sided parts"));
  if (solid.overlaps) found.push_back("surfaces that overlap or pass through each other");
  if (found.empty() && report.doubled_edges == 0) return "";
  if (report.doubled_triangles > 0)
    found.insert(found.begin(), count(report.doubled_triangles, "doubled triangle", "doubled triangles"));
  if (report.non_manifold_edges > 0)
    found.push_back(count(report.non_manifold_edges, "non-manifold edge", "non-manifold edges"));
  found.push_back(count(report.components, "component", "components"));
  std::string done = solid.inside == Inside::parity ? "inside is where rays cross the surface an odd number of times"
                                                    : "inside is where the winding number is above 1/2";
  if (solid.turned_triangles > 0) done = count(solid.turned_triangles, "triangle", "triangles") + " turned, " + done;
  return fmt::format("{}; {}", fmt::join(found, ", "), done);
}

// An empty octree of a mesh that bounds something is more likely a mistake than what was meant. What it bounds, if
// anything, is not asked of open meshes, nor of those whose surfaces cancel; warnings tell of these.
void refuse_if_missed(const std::string& input, const TriangleMesh& mesh, const MeshPlacement& placement,
                      const MeshReport& found) {
  Eigen::AlignedBox3d box;
  const Eigen::Matrix3d to_voxels = placement.frame.axes.inverse();
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) box.extend(to_voxels * (mesh.vertices[v] - placement.frame.origin));
  const Eigen::Vector3d size = box.sizes();
  const bool thin = size.minCoeff() < 1;
  if (!thin && (!found.closed() || found.doubled_triangles > 0)) return;
  const std::string of = found.components == 1 ? "it" : fmt::format("any of its {} parts", found.components);
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: no voxel's centre is inside {}: the mesh is {:.4g} x {:.4g} x {:.4g} voxels{}", input,
                          of, size.x(), size.y(), size.z(),
                          thin                    ? ""
                          : found.components == 1 ? ", but thinner than one everywhere"
                                                  : ", and its parts are thinner than one or far apart"),
              "use smaller voxels or a greater depth, or take every voxel that it touches (--rule touched)");
}

// Work and memory follow the surface. Where even a few bytes for every voxel on it are more than the machine has, that
// is said before it is tried.
void refuse_if_too_fine(const std::string& input, const TriangleMesh& mesh, const MeshPlacement& placement) {
  constexpr double kBytes = 16;  // a voxel on the surface, at the least
  const Eigen::Matrix3d to_voxels = placement.frame.axes.inverse();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = to_voxels * (mesh.vertices[t[1]] - mesh.vertices[t[0]]);
    const Eigen::Vector3d b = to_voxels * (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    area += a.cross(b).norm() / 2;
  }
  // What lies outside the universe costs nothing, so no more than all its voxels on every side are counted.
  const double side = std::ldexp(1.0, placement.depth);
  area = std::min(area, side * side * side);
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (!(area * kBytes > memory)) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: its surface is {:.2g} voxels large, which takes more than the {:.0f} GB of memory that "
                          "there are",
                          input, area, memory / 1e9),
              "use larger voxels or a smaller depth");
}

template <class Value>
Value choice(const char* option, const std::string& given,
             std::initializer_list<std::pair<const char*, Value>> values) {
  std::string all;
  for (const auto& [name, value] : values) {
    if (given == name) return value;
    all += (all.empty() ? "" : name == (values.end() - 1)->first ? " or " : ", ") + std::string(name);
  }
  throw Error(ErrorCode::bad_argument, fmt::format("{} is '{}', which is unknown", option, given), "use " + all);
}

}  // namespace

void declare_mesh_options(App& app, BuildOptions& o, Option* like) {
  const std::string meshes = "Options for meshes", both = "Options for meshes and point clouds";
  Option* fit = add_number(app, "--fit", o.fit, true,
                           "longest side as a fraction of the universe, above 0, at most 1 (default 0.75); centred");
  Option* size = add_number(app, "--voxel-size", o.voxel_size, true, "side of a voxel in the input's units");
  fit->group(both)->excludes(size)->excludes(like);
  size->group(both)->excludes(like);
  add_text(app, "--rule", o.rule, "RULE",
           "centre: a voxel is black iff its centre is inside (default); touched: iff it meets the solid at all")
      ->group(meshes);
  add_text(app, "--inside", o.inside, "HOW",
           "parity: where rays cross the surface an odd number of times (closed meshes only); winding: where the "
           "generalised winding number is above 1/2; automatic (default): parity for sound meshes, else winding")
      ->group(meshes);
}

Octree build_mesh(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  const std::string rule = o.rule.value_or("centre");
  const MeshOptions options = {
      choice<MeshRule>("--rule", rule, {{"centre", MeshRule::centre}, {"touched", MeshRule::touched}}),
      choice<Inside>("--inside", o.inside.value_or("automatic"),
                     {{"automatic", Inside::automatic}, {"parity", Inside::parity}, {"winding", Inside::winding}})};
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
  if (!like) refuse_if_too_fine(o.input, mesh, placement);
  facts["depth"] = placement.depth;
  facts["rule"] = rule;
  if (o.inside) facts["inside"] = *o.inside;
  const MeshSolid solid = session.stage("build", [&](const Work& work) {
    return naming(o.input, [&] { return solid_from_mesh(mesh, placement, options, work); });
  });
  if (solid.octree.is_empty()) {
    refuse_if_missed(o.input, mesh, placement, solid.found);
    if (solid.found.closed() && solid.found.doubled_triangles > 0)
      session.warn(o.input +
                   ": its surfaces cancel each other, as when every triangle is there a second time, turned " +
                   "over; remove the doubles");
  }
  if (const std::string line = faults(solid); !line.empty()) {
    facts["inside"] = solid.inside == Inside::parity ? "parity" : "winding";
    session.warn(o.input + ": " + line);
  }
  return solid.octree;
}

}  // namespace blackleaf::cli
