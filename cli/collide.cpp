// blackleaf collide: whether two solids interfere, by how much, how far apart they are.
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "blackleaf/contact.h"
#include "blackleaf/error.h"
#include "blackleaf/move.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"

namespace blackleaf::cli {
namespace {

struct Answer {
  bool interferes = false;
  std::optional<std::uint64_t> overlap;  // voxels; none in exact mode
  std::optional<Distance> apart;         // none in exact mode, when they interfere or when one is empty
};

// B where it is after its motion, as far as the universe holds it.
Octree moved(Session& session, const Octree& b, const Motion& motion, const std::string& name) {
  return session.stage("move", [&](const Work& work) {
    try {
      return move(b, motion, Leaving::error, work);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::out_of_universe) throw;
    }
    Octree inside = move(b, motion, Leaving::clip, work);
    session.warn(fmt::format("parts of the moved '{}' are outside the universe and are not looked at", name));
    return inside;
  });
}

Json as_json(const Answer& answer, bool exact) {
  Json report = {{"interferes", answer.interferes},
                 {"overlap_volume", nullptr},
                 {"distance", nullptr},
                 {"mode", exact ? "exact" : "voxelised"}};
  if (answer.overlap) report["overlap_volume"] = *answer.overlap;
  if (answer.interferes && !exact) report["distance"] = 0.0;
  if (answer.apart) report["distance"] = answer.apart->voxels;
  return report;
}

std::string as_text(const Answer& answer) {
  if (answer.interferes)
    return answer.overlap ? fmt::format("they interfere: the overlap is {}\n", counted(*answer.overlap, "voxel"))
                          : "they interfere\n";
  if (!answer.apart) return "they do not interfere\n";
  const auto& [voxels, squared, a, b] = *answer.apart;
  if (squared == 0) return fmt::format("they do not interfere, but touch at ({}, {}, {})\n", a[0], a[1], a[2]);
  return fmt::format("they do not interfere: {:.10g} voxels apart, from ({}, {}, {}) to ({}, {}, {})\n", voxels, a[0],
                     a[1], a[2], b[0], b[1], b[2]);
}

}  // namespace

int run_collide(Session& session) {
  Label first_label, second_label;
  std::string first_name, second_name;
  bool exact = false;
  MotionOptions motion_options;
  add_octree_input(session.app(), "A", first_name);
  add_octree_input(session.app(), "B", second_name, "octree file of the same depth");
  motion_options.add_to(session.app(), "B");
  session.app().add_flag("--exact", exact, "take the moved B as tilted cubes, not as voxels; no volume or distance");
  add_label(session.app(), first_label, "--label-a", "of a file A of many labels: the solid of this one");
  add_label(session.app(), second_label, "--label-b", "the same of B");
  session.add_json();
  session.set_example("blackleaf collide room.octree robot.octree --rotate 0,0,1:45 --about centroid");
  if (!session.parse()) return kDone;

  const std::pair<Octree, Octree> pair = read_pair(session, first_name, first_label, second_name, second_label);
  const Octree& a = pair.first;
  const Octree& b = pair.second;
  Answer answer;
  if (exact) {
    const Motion motion = motion_options.motion(b);
    answer.interferes = session.stage("collide", [&](const Work&) { return interferes(a, b, motion, Meaning::exact); });
  } else {
    const Octree target = motion_options.given() ? moved(session, b, motion_options.motion(b), second_name) : b;
    session.stage("collide", [&](const Work&) {
      answer.overlap = overlap_volume(a, target);
      answer.interferes = *answer.overlap > 0;
      if (!answer.interferes) answer.apart = distance(a, target);
    });
  }
  if (session.json())
    print_out(as_json(answer, exact));
  else if (!session.quiet())
    print_out(as_text(answer));
  return answer.interferes ? kNo : kDone;
}

}  // namespace blackleaf::cli
