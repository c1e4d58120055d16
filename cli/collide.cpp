// blackleaf collide: whether two solids interfere, by how much, how far apart they are.
#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "blackleaf/align.h"
#include "blackleaf/contact.h"
#include "blackleaf/distance.h"
#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "blackleaf/resample.h"
#include "blackleaf/set_operations.h"
#include "collide_path.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"
#include "options.h"
#include "poses.h"

namespace blackleaf::cli {
namespace {

struct Answer {
  bool interferes = false;
  std::optional<std::uint64_t> overlap;  // voxels; none in exact mode
  std::optional<MovedDistance> apart;    // none when they interfere or when one is empty
};

// Two nearest points of two octrees of one universe.
std::optional<MovedDistance> apart(const Octree& a, const Octree& b) {
  const std::optional<Distance> found = distance(a, b);
  if (!found) return std::nullopt;
  const auto point = [](const std::array<std::int32_t, 3>& p) { return Eigen::Vector3d(p[0], p[1], p[2]); };
  return MovedDistance{found->voxels, point(found->on_a), point(found->on_b)};
}

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
  if (answer.interferes) report["distance"] = 0.0;
  if (answer.apart) report["distance"] = answer.apart->voxels;
  return report;
}

std::string as_text(const Answer& answer) {
  if (answer.interferes)
    return answer.overlap ? fmt::format("they interfere: the overlap is {}\n", counted(*answer.overlap, "voxel"))
                          : "they interfere\n";
  if (!answer.apart) return "they do not interfere\n";
  const auto point = [](const Eigen::Vector3d& p) {
    return fmt::format("({:.10g}, {:.10g}, {:.10g})", p.x(), p.y(), p.z());
  };
  const auto& [voxels, on_a, on_b] = *answer.apart;
  if (voxels == 0) return fmt::format("they do not interfere, but touch at {}\n", point(on_a));
  return fmt::format("they do not interfere: {:.10g} voxels apart, from {} to {}\n", voxels, point(on_a), point(on_b));
}

// True iff black voxels of b lie outside the universe of a, in the world.
bool sticks_out(const Octree& b, const Octree& a) {
  const auto box = bounding_box(b);
  if (!box) return false;
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(a.frame().axes);
  for (unsigned corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at;
    for (std::size_t i = 0; i < 3; ++i)
      at[static_cast<Eigen::Index>(i)] = (corner >> i & 1) != 0 ? box->max[i] : box->min[i];
    const Eigen::Vector3d placed = lu.solve(b.frame().to_world(at) - a.frame().origin);
    constexpr double kDust = 1e-6;
    if (placed.minCoeff() < -kDust || placed.maxCoeff() > a.side() + kDust) return true;
  }
  return false;
}

// A and B as they are compared: in one universe.
std::pair<Octree, Octree> read_both(Session& session, const std::string& a_name, const Label& a_label,
                                    const std::string& b_name, const Label& b_label, bool align, bool resample) {
  if (a_name == "-" && b_name == "-")
    throw Error(ErrorCode::bad_argument, "both octrees are - for standard input", "name a file for one of them");
  const Octree a = read_solid(session, a_name, a_label), b = read_solid(session, b_name, b_label);
  if (align) {
    check_lattice(a, a_name, b, b_name);
    const std::vector<Octree> pair = session.stage("align", [&](const Work& work) {
      return aligned(std::vector{a, b}, work);
    });
    return {pair[0], pair[1]};
  }
  if (resample) {
    const Octree placed =
        session.stage("resample", [&](const Work& work) { return resampled(b, a.frame(), a.depth(), work); });
    if (sticks_out(b, a))
      session.warn(fmt::format("parts of '{}' are outside the universe of '{}' and are not looked at", b_name, a_name));
    return {a, placed};
  }
  check_voxel_sizes(a, a_name, b, b_name);
  check_one_universe(
      session, a, a_name, b, b_name,
      "build both in one universe, with build --like, or place them by their frames with --align or --resample");
  return {a, b};
}

// The answers for many poses; true iff they interfere at any.
bool ask_poses(Session& session, const Octree& a, const Octree& b, const std::vector<Motion>& motions, bool exact) {
  const std::vector<bool> answers = session.stage("collide", [&](const Work& work) {
    return interferes(PreparedSolid(a), PreparedSolid(b), motions, exact ? Meaning::exact : Meaning::voxelised, work);
  });
  const auto hits = std::count(answers.begin(), answers.end(), true);
  if (session.json()) {
    print_out(Json{{"poses", answers.size()},
                   {"interfering", hits},
                   {"interferes", answers},
                   {"mode", exact ? "exact" : "voxelised"}});
  } else if (!session.quiet()) {
    std::string text = fmt::format("they interfere at {} of {}", grouped(static_cast<std::uint64_t>(hits)),
                                   counted(answers.size(), "pose"));
    constexpr std::ptrdiff_t kShown = 20;
    std::ptrdiff_t shown = 0;
    for (std::size_t i = 0; i < answers.size() && shown < kShown; ++i)
      if (answers[i]) text += fmt::format("{}{}", shown++ == 0 ? ": " : ", ", i + 1);
    if (hits > shown) text += ", ...";
    print_out(text + "\n");
  }
  return hits > 0;
}

}  // namespace

int run_collide(Session& session) {
  Label first_label, second_label;
  std::string first_name, second_name;
  bool exact = false;
  bool align = false, resample = false;
  std::optional<std::string> poses_name, output;
  MotionOptions motion_options;
  CollidePath along;
  add_octree_input(session.app(), "A", first_name);
  add_octree_input(session.app(), "B", second_name, "octree file of the same depth");
  motion_options.add_to(session.app(), "B");
  Option* exact_flag =
      session.app().add_flag("--exact", exact, "take the moved B as tilted cubes, not as voxels; no volume");
  Option* poses = add_text(session.app(), "--poses", poses_name, "FILE",
                           "ask at many poses of B: one a line, x,y,z or x,y,z@x,y,z:degrees, or a path in JSON");
  add_text(session.app(), "-o,--output", output, "OUT", "write the octree of what they share")
      ->excludes(exact_flag)
      ->excludes(poses);
  along.add_to(session.app());
  Option* align_flag = session.app().add_flag(
      "--align", align, "place B by its frame, in the universe of A, doubled until it holds both");
  session.app()
      .add_flag("--resample", resample,
                "place B by its frame on the voxels of A, whatever its own are, in A's universe")
      ->excludes(align_flag);
  add_label(session.app(), first_label, "--label-a", "of a file A of many labels: the solid of this one");
  add_label(session.app(), second_label, "--label-b", "the same of B");
  session.add_json();
  session.set_example("blackleaf collide room.octree robot.octree --rotate 0,0,1:45 --about centroid");
  if (!session.parse()) return kDone;

  if (poses_name && motion_options.given())
    throw Error(ErrorCode::bad_argument, "--poses and another motion of B are both given", "leave out one of them");
  if (poses_name == "-" && (first_name == "-" || second_name == "-"))
    throw Error(ErrorCode::bad_argument, "an octree and the poses are both - for standard input",
                "name a file for one of them");
  along.check(first_name, second_name, motion_options.given() || exact || poses_name || output);
  if (output) check_octree_output(session, *output);
  const std::pair<Octree, Octree> pair =
      read_both(session, first_name, first_label, second_name, second_label, align, resample);
  const Octree& a = pair.first;
  const Octree& b = pair.second;
  if (along.given()) return along.answer(session, a, b) ? kNo : kDone;
  if (poses_name) {
    const std::vector<Motion> motions = read_poses(session, *poses_name, b);
    return ask_poses(session, a, b, motions, exact) ? kNo : kDone;
  }
  Answer answer;
  if (exact) {
    const Motion motion = motion_options.motion(b);
    session.stage("collide", [&](const Work&) {
      answer.interferes = interferes(a, b, motion, Meaning::exact);
      if (!answer.interferes) answer.apart = distance(a, b, motion);
    });
  } else {
    const Octree target = motion_options.given() ? moved(session, b, motion_options.motion(b), second_name) : b;
    session.stage("collide", [&](const Work&) {
      answer.overlap = overlap_volume(a, target);
      answer.interferes = *answer.overlap > 0;
      if (!answer.interferes) answer.apart = apart(a, target);
    });
    if (output) {
      const Octree common = session.stage("overlap", [&](const Work& work) { return intersect(a, target, work); });
      warn_if_empty(session, common);
      Json options = motion_options.as_json(motion_options.motion(b));
      options["with"] = base_name(second_name);
      write_octree(session, common, *output, first_name, options, as_json(answer, exact),
                   session.quiet() || session.json() || *output == "-" ? "" : as_text(answer));
      return answer.interferes ? kNo : kDone;
    }
  }
  if (session.json())
    print_out(as_json(answer, exact));
  else if (!session.quiet())
    print_out(as_text(answer));
  return answer.interferes ? kNo : kDone;
}

}  // namespace blackleaf::cli
