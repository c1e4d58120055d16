// blackleaf combine: set operations on two octrees of one universe.
#include <fmt/format.h>

#include <map>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/set_operations.h"
#include "commands.h"
#include "files.h"

namespace blackleaf::cli {

int run_combine(Session& session) {
  Label first_label, second_label;
  std::string first_name, second_name, operation, output;
  add_octree_input(session.app(), "A", first_name);
  session.app().add_option("OP", operation, "and, or, minus or xor")->required()->type_name("");
  add_octree_input(session.app(), "B", second_name, "octree file of the same depth");
  add_output(session.app(), output, "octree file to write, or - for standard output; it has the frame of A");
  add_label(session.app(), first_label, "--label-a", "of a file A of many labels: the solid of this one");
  add_label(session.app(), second_label, "--label-b", "the same of B");
  session.add_json();
  session.set_example("blackleaf combine bunny.octree minus ball.octree -o hollow.octree");
  if (!session.parse()) return kDone;

  using Operation = Octree (*)(const Octree&, const Octree&, const Work&);
  static const std::map<std::string, Operation> operations = {
      {"and", intersect}, {"or", unite}, {"minus", subtract}, {"xor", symmetric_difference}};
  const auto chosen = operations.find(operation);
  if (chosen == operations.end())
    throw Error(ErrorCode::bad_argument,
                fmt::format("unknown operation '{}' between '{}' and '{}'", operation, first_name, second_name),
                "use and, or, minus or xor");
  check_octree_output(session, output);
  const std::pair<Octree, Octree> pair = read_pair(session, first_name, first_label, second_name, second_label);
  const Octree& a = pair.first;
  const Octree& b = pair.second;
  const Octree result = session.stage("combine", [&](const Work& work) { return chosen->second(a, b, work); });
  Json options = {{"operation", operation}, {"with", base_name(second_name)}};
  if (first_label) options["label_a"] = *first_label;
  if (second_label) options["label_b"] = *second_label;
  write_octree(session, result, output, first_name, options);
  return kDone;
}

}  // namespace blackleaf::cli
