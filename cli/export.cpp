// blackleaf export: octrees as volumes, meshes and run streams for other programs.
#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "blackleaf/mesh_file.h"
#include "blackleaf/runs.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "commands.h"
#include "files.h"

namespace blackleaf::cli {
namespace {

enum class Kind { volume, mesh, runs };

Kind kind_of(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (path == "-" || suffix == ".runs") return Kind::runs;
  if (suffix == ".nrrd" || suffix == ".nii" || suffix == ".nii.gz" || suffix == ".mha") return Kind::volume;
  if (suffix == ".stl" || suffix == ".obj" || suffix == ".ply") return Kind::mesh;
  throw Error(ErrorCode::bad_argument, fmt::format("cannot export to '{}': unknown suffix '{}'", path, suffix),
              "use .nrrd, .nii, .nii.gz, .mha, .stl, .obj, .ply or .runs");
}

void print_runs(const Octree& octree) {
  constexpr std::size_t kPart = 1 << 16;
  std::string text;
  for_each_run(octree, [&](std::uint64_t count, bool black) {
    text += fmt::format("{} {}\n", count, black ? 1 : 0);
    if (text.size() < kPart) return;
    check_interrupt();
    print_out(text);
    text.clear();
  });
  check_interrupt();
  print_out(text);
}

}  // namespace

int run_export(Session& session) {
  std::string input, output;
  bool crop = false;
  add_octree_input(session.app(), "FILE", input);
  add_output(session.app(), output,
             "by suffix: .nrrd .nii .nii.gz .mha (0/1 volume), .stl .obj .ply (boundary faces), .runs (text); - prints "
             "the runs");
  session.app().add_flag("--crop", crop, "volumes: only the bounding box, not the whole universe");
  session.add_json();
  session.set_example("blackleaf export bunny.octree -o bunny.nii.gz --crop");
  if (!session.parse()) return kDone;

  const Kind kind = kind_of(output);
  if (crop && kind != Kind::volume)
    throw Error(ErrorCode::bad_argument, fmt::format("--crop does not apply to '{}', which is no volume", output),
                "leave it out");
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the runs to a file");
  if (output != "-") check_output(output);

  const Octree octree = read_octree(session, input).octree;
  TriangleMesh mesh;
  if (kind == Kind::mesh) mesh = session.stage("build", [&](const Work&) { return boundary_mesh(octree); });
  session.write_stage([&] {
    if (output == "-")
      print_runs(octree);
    else if (kind == Kind::volume)
      write_volume(octree, output, crop);
    else if (kind == Kind::mesh)
      write_mesh(mesh, output);
    else
      write_runs(octree, output);
  });

  if (output == "-") return kDone;
  const std::optional<std::uint64_t> bytes = size_of(output);
  Json report = {{"output", output}, {"file_bytes", bytes ? Json(*bytes) : Json()}};
  std::string what = kind == Kind::volume ? "volume" : "runs";
  if (kind == Kind::mesh) {
    report["triangles"] = mesh.triangles.size();
    what = fmt::format("{} triangles", grouped(mesh.triangles.size()));
  }
  if (session.json())
    print_out(report);
  else if (!session.quiet())
    print_out(fmt::format("{}: {}{}\n", output, what, bytes ? ", " + counted(*bytes, "byte") : ""));
  return kDone;
}

}  // namespace blackleaf::cli
