// blackleaf-mpi build: octrees of volumes that many ranks read together.
#include "build.h"

#include <fmt/format.h>

#include "exit_codes.h"
#include "files.h"
#include "mpi/volume_part.h"
#include "options.h"
#include "ranks_machine.h"

namespace blackleaf::cli {

int run_shared_build(Session& session, RanksMachine& machine) {
  BuildOptions o;
  std::optional<std::string> dataset;
  App& app = session.app();
  app.add_option("INPUT", o.input, "volume: NRRD, MetaImage or NIfTI with raw values, or HDF5")
      ->required()
      ->type_name("");
  add_output(app, o.output, "octree file to write");
  Option* depth = add_integer(app, "--depth", o.depth, 1, kMaxDepth,
                              "1 to 20: the universe has 2^N voxels a side (default: the smallest that holds all)");
  Option* like =
      add_text(app, "--like", o.like, "FILE.octree", "use the universe of another octree: its depth and frame");
  like->excludes(depth);
  declare_volume_options(app, o, like);
  add_text(app, "--dataset", dataset, "NAME", "of an HDF5 file: which one (default: the only one of three dimensions)")
      ->group("Options for volumes");
  session.add_json();
  session.set_example("mpirun -n 8 blackleaf-mpi build scan.nhdr -o scan.octree --range 1200:");
  if (!session.parse()) return kDone;

  check_octree_output(session, o.output);
  if (o.input == "-") throw Error(ErrorCode::bad_argument, "standard input cannot be built from", "name a file");
  check_input_or_folder(o.input, "a volume");
  if (suffix_of(o.input) == ".octree")
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is an octree already", o.input),
                "use move, combine or export");
  if (!mpi::is_hdf5_name(o.input) && !is_volume(o.input))
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is no volume", o.input),
                "build it with blackleaf; blackleaf-mpi builds from volumes, which need many machines");
  std::optional<Octree> like_octree;
  if (o.like) like_octree = read_octree(session, *o.like).octree;

  Json facts = Json::object();
  mpi::VolumePartOptions options;
  options.volume = volume_options(session, o, like_octree, facts);
  if (like_octree) options.frame = like_octree->frame();
  if (dataset) {
    options.dataset = *dataset;
    facts["dataset"] = *dataset;
  }
  options.memory_limit = machine.memory_limit();
  const Made made = session.stage(
      "build", [&](const Work& work) { return made_of(mpi::read_volume(machine.ranks(), o.input, options, work)); });
  facts["depth"] = made.octree.depth();
  warn_if_empty(session, made);
  write_octree(session, made, o.output, o.input, facts);
  return kDone;
}

}  // namespace blackleaf::cli
