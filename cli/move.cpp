// blackleaf move: WA87's rotation and translation.
#include "blackleaf/move.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "blackleaf/label_map.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"

namespace blackleaf::cli {
namespace {

// WA87's Table 2 in columns: black leaves B, internal nodes I, most internal nodes held at once M, voxels V, and I/V.
// The paper makes nodes that later leaves turn out to be superfluous, so its M is above I. Here a node is made when all
// below it is known and only if it stays: M = I. The source is not computed and has no M.
std::string table(const Told& source, const Told& target) {
  const auto share = [](const Told& m) {
    return m.volume == 0 ? std::string("-")
                         : fmt::format("{:.3g}", static_cast<double>(m.internal_nodes) / static_cast<double>(m.volume));
  };
  std::string text = fmt::format("{:<8}{:>14}{:>14}{:>14}{:>20}{:>10}\n", "", "B", "I", "M", "V", "I/V");
  text += fmt::format("{:<8}{:>14}{:>14}{:>14}{:>20}{:>10}\n", "source", source.black_leaves, source.internal_nodes,
                      "-", source.volume, share(source));
  text += fmt::format("{:<8}{:>14}{:>14}{:>14}{:>20}{:>10}\n", "target", target.black_leaves, target.internal_nodes,
                      target.internal_nodes, target.volume, share(target));
  return text;
}

Json row(const Told& m) {
  Json object = {{"black_leaves", m.black_leaves}, {"internal_nodes", m.internal_nodes}, {"volume", m.volume}};
  object["internal_nodes_per_voxel"] = nullptr;
  if (m.volume > 0)
    object["internal_nodes_per_voxel"] = static_cast<double>(m.internal_nodes) / static_cast<double>(m.volume);
  return object;
}

}  // namespace

int run_move(Session& session) {
  Label label;
  std::string input, output;
  bool stats = false;
  MotionOptions motion_options;
  LeavingOptions leaving;
  add_octree_input(session.app(), "FILE", input);
  add_output(session.app(), output, "octree file to write, or - for standard output");
  motion_options.add_to(session.app(), "the solid");
  motion_options.add_reflection_to(session.app(), "the solid");
  leaving.add_to(session.app());
  add_label(session.app(), label);
  session.app().add_flag("--stats", stats, "report WA87's Table 2: B, I, M, V, I/V of source and target");
  session.add_json();
  session.set_example(
      "blackleaf move bunny.octree --rotate 0,0,1:30 --translate 0,-5,2.5 --about centroid -o turned.octree");
  if (!session.parse()) return kDone;

  check_octree_output(session, output);
  const OctreeFile file = read_octree(session, input);
  if (label && !file.labels) refuse_label(input);
  const bool all_labels = file.labels && !label;
  const Octree source = label ? solid_of(*file.labels, *label, input) : file.octree;
  const LatticeSymmetry reflection = motion_options.reflection();
  const Motion motion = motion_options.motion(source);
  if (!motion_options.moves())
    session.warn(
        "no motion is given, so the solid stays where it is; give --rotate, --translate, --matrix or --reflect");
  std::optional<LabelMap> labels;
  Made target;
  session.stage("move", [&](const Work& work) {
    if (all_labels)
      labels = move(transform(*file.labels, reflection, work), motion, leaving.choice(), work);
    else
      target = session.machine().move(source, reflection, motion, leaving.choice(), work);
  });
  Json options = motion_options.as_json(motion);
  options["leaving"] = leaving.name();
  if (label) options["label"] = *label;
  Json more = Json::object();
  std::string rows;
  if (stats && (session.json() || output != "-")) {
    const auto [before, after] = session.stage("measure", [&](const Work&) {
      return std::pair(Machine().tell_of({source}),
                       labels ? Machine().tell_of({octree_from_labels(*labels)}) : session.machine().tell_of(target));
    });
    more["stats"] = {{"source", row(before)}, {"target", row(after)}};
    more["stats"]["target"]["peak_internal_nodes"] = after.internal_nodes;
    if (!session.json()) rows = table(before, after);
  }
  if (labels) {
    write_labels(session, *labels, output, input, options, more, rows);
  } else {
    warn_if_empty(session, target);
    write_octree(session, target, output, input, options, more, rows);
  }
  return kDone;
}

}  // namespace blackleaf::cli
