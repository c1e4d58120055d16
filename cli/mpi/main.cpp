// blackleaf-mpi: what many processes do together. All ranks run the same command; whatever goes wrong on one of them
// ends all with its message, told by the first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "commands.h"
#include "interrupt.h"
#include "program.h"
#include "ranks_machine.h"

namespace blackleaf::cli {
namespace {

struct Command {
  const char* name;
  const char* description;
  int (*run)(Session&, RanksMachine&);
  bool alone;  // by the first rank, as blackleaf does it, unless raw values are written
};

template <int (*kRun)(Session&)>
int same(Session& session, RanksMachine&) {
  return kRun(session);
}

constexpr std::array<Command, 6> kCommands = {{
    {"build", "make the octree of a volume, each rank reading its own part of it", run_shared_build, false},
    {"info", "measure an octree: volume, surface, nodes, bounding box, ...", same<run_info>, true},
    {"translate", "shift an octree by whole voxels, without loss", same<run_translate>, false},
    {"move", "rotate and translate an octree", same<run_move>, false},
    {"combine", "unite, intersect or subtract octrees", same<run_combine>, false},
    {"export", "write an octree as a volume, a mesh or a run stream", same<run_export>, true},
}};

std::string help() {
  return help_text(
      "blackleaf-mpi: solid octrees beyond one machine\nUsage: mpirun -n P blackleaf-mpi COMMAND [OPTIONS] ...",
      kCommands,
      "\nFiles are those that blackleaf writes, byte for byte, whatever P is.\n"
      "\nExit status: 0 done; 2 bad usage or input; 3 internal fault\n"
      "\nExample:\n"
      "  mpirun -n 8 blackleaf-mpi build scan.nhdr -o scan.octree --range 1200:\n");
}

int run(const std::vector<std::string>& arguments, mpi::Ranks& ranks) {
  if (arguments.empty()) {
    if (ranks.first()) fmt::print(stderr, "{}", help());
    return kBadInput;
  }
  if (answered(arguments.front(), "blackleaf-mpi", help())) return kDone;
  const Command& command = command_named(arguments.front(), kCommands, "blackleaf-mpi");
  const bool alone = command.alone && std::find(arguments.begin(), arguments.end(), "--raw") == arguments.end();
  if (alone && !ranks.first()) return kDone;
  RanksMachine together(ranks);
  Machine one;
  Machine& machine = alone ? one : together;
  Session session(command.name, command.description, {arguments.begin() + 1, arguments.end()}, machine);
  const int code = command.run(session, together);
  session.print_remarks();
  session.print_timings();
  return code;
}

}  // namespace
}  // namespace blackleaf::cli

int main(int argc, char** argv) {
  using namespace blackleaf;
  mpi::Ranks ranks(argc, argv);
  const auto end = [&](const mpi::Failure& failure) {
    cli::print_message(failure.what());
    return failure.code();
  };
  try {
    cli::watch_for_interrupt();
    cli::set_program("blackleaf-mpi", ranks.first());
    const int code = cli::run({argv + (argc > 0 ? 1 : 0), argv + argc}, ranks);
    ranks.meet();
    return code;
  } catch (const mpi::Failure& failure) {
    return end(failure);
  } catch (const mpi::Ranks::Stopped&) {
    return end(ranks.fail(0, {}));
  } catch (...) {
    const cli::Ending ending = cli::ending_of_current_exception();
    return end(ranks.fail(ending.code, ending.message));
  }
}
