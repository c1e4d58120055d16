// blackleaf export: octrees as volumes, meshes and run streams for other programs.
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "blackleaf/mesh_file.h"
#include "blackleaf/runs.h"
#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "commands.h"
#include "files.h"
#include "labels.h"

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

// Prints the runs that for_each(visit) tells of as visit(count, colour).
template <class ForEach>
void print_runs(const ForEach& for_each) {
  constexpr std::size_t kPart = 1 << 16;
  std::string text;
  for_each([&](std::uint64_t count, std::uint32_t colour) {
    text += fmt::format("{} {}\n", count, colour);
    if (text.size() < kPart) return;
    check_interrupt();
    print_out(text);
    text.clear();
  });
  check_interrupt();
  print_out(text);
}

void print_runs(const Octree& octree) {
  print_runs([&](const auto& visit) {
    for_each_run(octree, [&](std::uint64_t count, bool black) { visit(count, black ? 1 : 0); });
  });
}

void print_runs(const LabelMap& labels) {
  print_runs([&](const auto& visit) {
    for (std::size_t run = 0; run < labels.run_count(); ++run) visit(labels.count(run), labels.labels()[run]);
  });
}

}  // namespace

int run_export(Session& session) {
  std::string input, output;
  Label label;
  bool crop = false, raw = false;
  add_octree_input(session.app(), "FILE", input);
  add_output(session.app(), output,
             "by suffix: .nrrd .nii .nii.gz .mha (0/1 or labelled volume), .stl .obj .ply (boundary faces), .runs "
             "(text); - prints "
             "the runs");
  session.app().add_flag("--crop", crop, "volumes: only the bounding box, not the whole universe");
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf export bunny.octree -o bunny.nii.gz --crop");
  session.app().add_flag("--raw", raw,
                         "of .nrrd: values as they are instead of packed, as blackleaf-mpi build wants them");
  if (!session.parse()) return kDone;

  const Kind kind = kind_of(output);
  if (crop && kind != Kind::volume)
    throw Error(ErrorCode::bad_argument, fmt::format("--crop does not apply to '{}', which is no volume", output),
                "leave it out");
  if (raw && suffix_of(output) != ".nrrd")
    throw Error(ErrorCode::bad_argument, fmt::format("--raw does not apply to '{}'", output), "name it *.nrrd");
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the runs to a file");
  if (output != "-") check_output(output);

  // Volumes and runs carry labels; a mesh is the boundary of one solid.
  std::optional<LabelMap> labels;
  Octree octree;
  if (kind == Kind::mesh || label) {
    octree = read_solid(session, input, label);
  } else {
    OctreeFile file = read_octree(session, input);
    labels = std::move(file.labels);
    octree = std::move(file.octree);
  }
  if (raw && labels)
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' has labels, and --raw writes one solid", input),
                "choose one with --label, or leave --raw out");
  TriangleMesh mesh;
  if (kind == Kind::mesh) mesh = session.stage("build", [&](const Work&) { return boundary_mesh(octree); });
  session.write_stage([&] {
    if (kind == Kind::mesh)
      write_mesh(mesh, output);
    else if (output == "-")
      labels ? print_runs(*labels) : print_runs(octree);
    else if (kind == Kind::volume)
      labels ? write_volume(*labels, output, crop)
      : raw  ? session.machine().write_raw_volume(octree, output, crop)
             : write_volume(octree, output, crop);
    else
      labels ? write_runs(*labels, output) : write_runs(octree, output);
  });

  if (output == "-") return kDone;
  const std::optional<std::uint64_t> bytes = size_of(output);
  Json report = {{"output", output}, {"file_bytes", bytes ? Json(*bytes) : Json()}};
  std::string what = std::string(labels ? "labelled " : "") + (kind == Kind::volume ? "volume" : "runs");
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
