// blackleaf translate: AN84's shift by whole voxels.
#include "blackleaf/move.h"

#include "commands.h"
#include "files.h"
#include "motion_options.h"
#include "options.h"

namespace blackleaf::cli {

int run_translate(Session& session) {
  Label label;
  std::string input, by_text, output;
  LeavingOptions leaving;
  add_octree_input(session.app(), "FILE", input);
  session.app().add_option("BY", by_text, "dx,dy,dz: whole voxels")->required()->type_name("");
  add_output(session.app(), output, "octree file to write, or - for standard output");
  leaving.add_to(session.app());
  add_label(session.app(), label, "--label", "of a file of many labels: only the solid of this one");
  session.add_json();
  session.set_example("blackleaf translate bunny.octree -10,0,4 -o shifted.octree");
  if (!session.parse()) return kDone;

  const auto by = parse_integer_vector("displacement", by_text);
  check_octree_output(session, output);
  Json options = {{"by", by}, {"leaving", leaving.name()}};
  if (label) options["label"] = *label;
  const OctreeFile file = read_octree(session, input);
  if (label && !file.labels) refuse_label(input);
  if (file.labels && !label) {
    const LabelMap target =
        session.stage("move", [&](const Work& work) { return translate(*file.labels, by, leaving.choice(), work); });
    write_labels(session, target, output, input, options);
    return kDone;
  }
  const Octree source = label ? solid_of(*file.labels, *label, input) : file.octree;
  const Made target = session.stage(
      "move", [&](const Work& work) { return session.machine().translate(source, by, leaving.choice(), work); });
  warn_if_empty(session, target);
  write_octree(session, target, output, input, options);
  return kDone;
}

}  // namespace blackleaf::cli
