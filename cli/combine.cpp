// blackleaf combine: set operations on octrees of one universe.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "blackleaf/align.h"
#include "blackleaf/error.h"
#include "blackleaf/set_operations.h"
#include "commands.h"
#include "files.h"

namespace blackleaf::cli {
namespace {

// A without all the others.
Octree subtract_all(std::span<const Octree> octrees, const Work& work) {
  return subtract(octrees.front(), octrees.size() == 2 ? octrees.back() : unite(octrees.subspan(1), work), work);
}

SetOperation operation_of(const std::string& name, const std::string& before, const std::string& after) {
  static const std::map<std::string, SetOperation> operations = {
      {"and", intersect}, {"or", unite}, {"minus", subtract_all}, {"xor", symmetric_difference}};
  const auto chosen = operations.find(name);
  if (chosen == operations.end())
    throw Error(ErrorCode::bad_argument,
                fmt::format("unknown operation '{}' between '{}' and '{}'", name, before, after),
                "use and, or, minus or xor");
  return chosen->second;
}

}  // namespace

int run_combine(Session& session) {
  Label first_label, other_label;
  std::string first_name, operation, output;
  std::vector<std::string> other_names;
  bool align = false;
  add_octree_input(session.app(), "A", first_name);
  session.app().add_option("OP", operation, "and, or, minus or xor")->required()->type_name("");
  session.app()
      .add_option("B", other_names,
                  "octree files of the same depth; of several, minus takes away all, xor is an odd number")
      ->required()
      ->type_name("");
  add_output(session.app(), output, "octree file to write, or - for standard output; it has the frame of A");
  session.app().add_flag("--align", align,
                         "place all by their frames, in the universe of A, doubled until it holds them");
  add_label(session.app(), first_label, "--label-a", "of a file A of many labels: the solid of this one");
  add_label(session.app(), other_label, "--label-b", "the same of every B");
  session.add_json();
  session.set_example("blackleaf combine bunny.octree minus ball.octree -o hollow.octree");
  if (!session.parse()) return kDone;

  const SetOperation chosen = operation_of(operation, first_name, other_names.front());
  if ((first_name == "-" ? 1 : 0) + std::count(other_names.begin(), other_names.end(), "-") > 1)
    throw Error(ErrorCode::bad_argument, "more than one octree is - for standard input", "name files for the others");
  check_octree_output(session, output);
  std::vector<Octree> octrees = {read_solid(session, first_name, first_label)};
  for (const std::string& name : other_names) {
    if (align) {
      octrees.push_back(read_solid(session, name, other_label));
      check_lattice(octrees.front(), first_name, octrees.back(), name);
    } else {
      octrees.push_back(read_beside(session, octrees.front(), first_name, name, other_label,
                                    "build both in one universe, with build --like, or place them by their frames "
                                    "with --align"));
    }
  }
  const Made result = session.stage("combine", [&](const Work& work) {
    if (align) octrees = aligned(octrees, work);
    return session.machine().combine(octrees, chosen, work);
  });
  warn_if_empty(session, result);
  Json with = Json::array();
  for (const std::string& name : other_names) with.push_back(base_name(name));
  Json options = {{"operation", operation}, {"with", with.size() == 1 ? with.front() : with}};
  if (align) options["align"] = true;
  if (first_label) options["label_a"] = *first_label;
  if (other_label) options["label_b"] = *other_label;
  write_octree(session, result, output, first_name, options);
  return kDone;
}

}  // namespace blackleaf::cli
