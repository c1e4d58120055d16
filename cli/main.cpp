// blackleaf: the command-line program. Finds the subcommand, runs it, and turns what it throws into an exit code.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "program.h"

namespace blackleaf::cli {
namespace {

struct Command {
  const char* name;
  const char* description;
  int (*run)(Session&);
};

// In the order in which one meets them.
constexpr std::array<Command, 16> kCommands = {{
    {"build", "make the octree of a mesh, volume, point cloud, silhouettes or run stream", run_build},
    {"info", "measure an octree: volume, surface, nodes, bounding box, ...", run_info},
    {"translate", "shift an octree by whole voxels, without loss", run_translate},
    {"move", "rotate and translate an octree", run_move},
    {"combine", "unite, intersect or subtract octrees", run_combine},
    {"offset", "grow or shrink an octree by a ball; open or close it", run_offset},
    {"collide", "ask whether two octrees interfere, by how much, how far apart they are", run_collide},
    {"ray", "find where a ray meets an octree", run_ray},
    {"plan", "find a way for an octree from one pose to another that touches nothing", run_plan},
    {"sweep", "find the space that an octree passes through along a path", run_sweep},
    {"animate", "make a sequence of octrees or pictures along a path", run_animate},
    {"draw", "draw an octree as lines, hidden ones removed", run_draw},
    {"export", "write an octree as a volume, a mesh or a run stream", run_export},
    {"curve", "convert between node numbers and voxels of the Millar curve", run_curve},
    {"verify", "check every checksum and invariant of an octree file", run_verify},
    {"reproduce", "compute the papers' tables and figures afresh, beside the printed ones", run_reproduce},
}};

std::string help() {
  return help_text(
      "blackleaf: solid octrees of real objects that move\nUsage: blackleaf COMMAND [OPTIONS] ...", kCommands,
      "\nExit status: 0 done; 1 the answer is no, or they interfere; 2 bad usage or input; 3 internal fault\n"
      "\nExample:\n"
      "  blackleaf build bunny.stl -o bunny.octree && blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg\n");
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    fmt::print(stderr, "{}", help());
    return kBadInput;
  }
  if (answered(arguments.front(), "blackleaf", help())) return kDone;
  const Command& command = command_named(arguments.front(), kCommands, "blackleaf");
  Machine machine;
  Session session(command.name, command.description, {arguments.begin() + 1, arguments.end()}, machine);
  const int code = command.run(session);
  session.print_remarks();
  session.print_timings();
  return code;
}

}  // namespace
}  // namespace blackleaf::cli

int main(int argc, char** argv) {
  try {
    blackleaf::cli::watch_for_interrupt();
    return blackleaf::cli::run({argv + (argc > 0 ? 1 : 0), argv + argc});
  } catch (...) {
    return blackleaf::cli::report_current_exception();
  }
}
