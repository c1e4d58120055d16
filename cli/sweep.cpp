// blackleaf sweep: the space that a solid passes through on its way along a path.
#include "blackleaf/sweep.h"

#include <optional>
#include <vector>

#include "blackleaf/label_map.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"
#include "options.h"
#include "path_input.h"

namespace blackleaf::cli {

int run_sweep(Session& session) {
  Label label;
  std::string input, path_name, output;
  std::optional<double> step;
  LeavingOptions leaving;
  add_octree_input(session.app(), "FILE", input);
  add_path_input(session.app(), path_name);
  add_output(session.app(), output, "octree file to write, or - for standard output");
  add_number(session.app(), "--step", step, true,
             "look at the solid so often that no point of it travels F voxels in between (default 1)");
  leaving.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf sweep bunny.octree --path hop.json -o swept.octree");
  if (!session.parse()) return kDone;

  check_octree_output(session, output);
  const Path path = read_path_input(session, path_name, input);
  const OctreeFile file = read_octree(session, input);
  if (label && !file.labels) refuse_label(input);
  const bool all_labels = file.labels && !label;
  const Octree source = label ? solid_of(*file.labels, *label, input) : file.octree;
  const std::vector<Motion> motions = motions_along(source, path, step.value_or(1));
  std::optional<LabelMap> labels;
  Octree swept;
  session.stage("sweep", [&](const Work& work) {
    if (all_labels)
      labels = sweep(*file.labels, motions, leaving.choice(), work);
    else
      swept = sweep(source, motions, leaving.choice(), work);
  });
  Json options = {{"path", base_name(path_name)},
                  {"step", step.value_or(1)},
                  {"motions", motions.size()},
                  {"leaving", leaving.name()}};
  if (label) options["label"] = *label;
  const Json more = {{"motions", motions.size()}};
  if (labels) {
    write_labels(session, *labels, output, input, options, more);
  } else {
    warn_if_empty(session, swept);
    write_octree(session, swept, output, input, options, more);
  }
  return kDone;
}

}  // namespace blackleaf::cli
