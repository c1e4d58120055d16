// blackleaf verify: whether an octree file is whole.
#include <fmt/format.h>

#include <optional>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "commands.h"
#include "files.h"

namespace blackleaf::cli {
namespace {

// What is wrong with a file; empty if nothing is. Throws for one that is no octree file at all: the question does not
// apply to it.
std::string problem_of(const std::vector<std::uint8_t>& bytes, const std::string& name,
                       std::optional<OctreeFile>& file) {
  try {
    file = from_bytes(bytes, name);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input || !is_octree_data(bytes)) throw;
    return error.what();
  }
  const std::string broken = validate(file->octree);
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
  std::optional<OctreeFile> file;
  const std::string problem = session.stage("verify", [&](const Work&) { return problem_of(bytes, name, file); });

  if (session.json())
    print_out(Json{{"file", input}, {"ok", problem.empty()}, {"problem", problem.empty() ? Json() : Json(problem)}});
  else if (!session.quiet())
    print_out(problem.empty()
                  ? fmt::format("{}: ok, depth {}, {}{} voxels, {} bytes\n", name, file->octree.depth(),
                                file->labels ? counted_labels(label_facts(*file->labels).size()) + ", " : "",
                                grouped(volume(file->octree)), grouped(bytes.size()))
                  : fmt::format("damaged: {}\n", problem));
  return problem.empty() ? kDone : kNo;
}

}  // namespace blackleaf::cli
