// blackleaf verify: whether an octree file is whole.
#include <fmt/format.h>

#include <algorithm>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "commands.h"
#include "files.h"

namespace blackleaf::cli {
namespace {

// What is wrong with a file that says it is an octree; empty if nothing is.
std::string problem_of(const std::vector<std::uint8_t>& bytes, const std::string& name, std::optional<Octree>& octree) {
  try {
    octree = from_bytes(bytes, name).octree;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input) throw;
    return error.what();
  }
  const std::string broken = validate(*octree);
  return broken.empty() ? "" : fmt::format("{}: {}", name, broken);
}

}  // namespace

int run_verify(Session& session) {
  std::string input;
  add_octree_input(session.app(), "FILE", input);
  session.add_json();
  session.set_example("blackleaf verify bunny.octree && echo whole");
  if (!session.parse()) return kDone;

  const std::string name = input == "-" ? "standard input" : input;
  const std::vector<std::uint8_t> bytes = session.stage("read", [&](const Work&) { return read_bytes(input); });
  if (!is_octree_data(bytes))
    throw Error(ErrorCode::bad_input, fmt::format("'{}' is not an octree file", name), "make one with blackleaf build");
  std::optional<Octree> octree;
  const std::string problem = session.stage("verify", [&](const Work&) { return problem_of(bytes, name, octree); });

  if (session.json())
    print_out(Json{{"file", input}, {"ok", problem.empty()}, {"problem", problem.empty() ? Json() : Json(problem)}});
  else if (!session.quiet())
    print_out(problem.empty() ? fmt::format("{}: ok, depth {}, {} voxels, {} bytes\n", name, octree->depth(),
                                            grouped(volume(*octree)), grouped(bytes.size()))
                              : fmt::format("{}: damaged: {}\n", name, problem));
  return problem.empty() ? kDone : kNo;
}

}  // namespace blackleaf::cli
