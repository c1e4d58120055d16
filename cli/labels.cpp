#include "labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/octree_file.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : "'" + path + "'"; }

// Which labels there are, in increasing order: "1 to 90, 95, 101 to 116", cut short.
std::string listed(const std::vector<std::uint32_t>& labels) {
  constexpr int kMost = 12;
  std::string text;
  int parts = 0;
  for (std::size_t i = 0; i < labels.size();) {
    std::size_t last = i;
    while (last + 1 < labels.size() && labels[last + 1] == labels[last] + 1) ++last;
    if (parts++ == kMost) return text + ", ...";
    if (!text.empty()) text += ", ";
    text += std::to_string(labels[i]);
    if (last > i) text += (last == i + 1 ? ", " : " to ") + std::to_string(labels[last]);
    i = last + 1;
  }
  return text;
}

std::vector<std::uint32_t> different_labels(const LabelMap& map) {
  std::vector<std::uint32_t> labels(map.labels().begin(), map.labels().end());
  std::ranges::sort(labels);
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

}  // namespace

Option* add_label(App& app, Label& target, const std::string& name, const std::string& description) {
  return app
      .add_option_function(
          name,
          [&target, name](const std::string& text) {
            target =
                static_cast<std::uint32_t>(parse_integer(name, text, 0, std::numeric_limits<std::uint32_t>::max()));
          },
          description)
      ->type_name("L");
}

std::string counted_labels(std::size_t labels) { return counted(labels, "label"); }

Octree solid_of(const LabelMap& labels, std::uint32_t label, const std::string& name) {
  const auto all = labels.labels();
  if (std::find(all.begin(), all.end(), label) != all.end()) return octree_from_label(labels, label);
  std::vector<std::uint32_t> there = different_labels(labels);
  if (!there.empty() && there.front() == 0) there.erase(there.begin());
  if (there.empty())
    throw Error(ErrorCode::bad_argument, fmt::format("{} has no label {}, nor any but 0", shown_name(name), label),
                "leave --label out");
  throw Error(ErrorCode::bad_argument, fmt::format("{} has no label {}", shown_name(name), label),
              fmt::format("it has {}: {}", counted_labels(there.size()), listed(there)));
}

void refuse_label(const std::string& name) {
  throw Error(ErrorCode::bad_argument, fmt::format("{} holds one solid without labels", shown_name(name)),
              "leave --label out");
}

Octree read_solid(Session& session, const std::string& path, const Label& label) {
  OctreeFile file = read_octree(session, path);
  if (!file.labels) {
    if (label) refuse_label(path);
    return file.octree;
  }
  if (label) return session.stage("read", [&](const Work&) { return solid_of(*file.labels, *label, path); });
  std::vector<std::uint32_t> there = different_labels(*file.labels);
  std::erase(there, 0u);
  const bool pair = session.command() == "collide" || session.command() == "combine";
  session.note(fmt::format("{} holds {}; all but 0 taken as one solid; {} takes one", shown_name(path),
                           counted_labels(there.size()), pair ? "--label-a or --label-b L" : "--label L"));
  return file.octree;
}

void write_labels(Session& session, const LabelMap& labels, const std::string& path, const std::string& source,
                  const Json& options, const Json& more, const std::string& before) {
  std::vector<std::uint32_t> there = different_labels(labels);
  std::erase(there, 0u);
  if (there.empty()) session.warn("no voxel has a label but 0");
  const std::string metadata = metadata_text(session, source, options);
  if (path == "-") {
    print_octree_bytes(session, [&] { return to_bytes(labels, metadata); });
    return;
  }
  const bool telling = session.json() || !session.quiet();
  Measures solid;
  if (telling) solid = session.stage("measure", [&](const Work&) { return measure(octree_from_labels(labels)); });
  session.write_stage([&] { session.machine().once([&] { save(labels, path, metadata); }); });
  if (!before.empty()) print_out(before);
  if (!telling) return;
  const std::optional<std::uint64_t> file_bytes = size_of(path);
  if (session.json()) {
    Json report = {{"output", path},
                   {"depth", labels.depth()},
                   {"volume", solid.volume},
                   {"black_leaves", solid.black_leaves},
                   {"internal_nodes", solid.internal_nodes},
                   {"label_count", there.size()},
                   {"label_runs", labels.run_count()},
                   {"memory_bytes", labels.memory_bytes()},
                   {"file_bytes", file_bytes ? Json(*file_bytes) : Json()}};
    report.update(more);
    print_out(report);
    return;
  }
  print_out(fmt::format("{}: depth {}, {}, {}, {}{}\n", path, labels.depth(), counted_labels(there.size()),
                        counted(solid.volume, "voxel"), counted(labels.run_count(), "run"),
                        file_bytes ? ", " + counted(*file_bytes, "byte") : ""));
}

}  // namespace blackleaf::cli
