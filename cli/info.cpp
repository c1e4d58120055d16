// blackleaf info: what can be said of an octree in numbers.
#include <fmt/format.h>

#include "blackleaf/measures.h"
#include "commands.h"
#include "files.h"
#include "labels.h"

namespace blackleaf::cli {
namespace {

Json vector_json(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({:.10g}, {:.10g}, {:.10g})", v[0], v[1], v[2]);
}

Json as_json(const OctreeFile& file, const Measures& measures) {
  const Frame& frame = file.octree.frame();
  Json report = {{"depth", file.octree.depth()},
                 {"black_leaves", measures.black_leaves},
                 {"white_leaves", measures.white_leaves},
                 {"internal_nodes", measures.internal_nodes},
                 {"black_leaves_by_level", measures.black_leaves_by_level},
                 {"volume", measures.volume},
                 {"surface_area", measures.surface_area},
                 {"bounding_box", nullptr},
                 {"centroid", nullptr},
                 {"runs", measures.runs},
                 {"memory_bytes", file.octree.memory_bytes()},
                 {"file_bytes", file.file_bytes}};
  if (measures.bounding_box) report["bounding_box"] = {measures.bounding_box->min, measures.bounding_box->max};
  if (measures.centroid) report["centroid"] = vector_json(*measures.centroid);
  Json axes = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i) axes.push_back(vector_json(frame.axes.col(i)));
  report["frame"] = {{"origin", vector_json(frame.origin)}, {"axes", axes}, {"unit", frame.unit}};
  report["metadata"] = Json::parse(file.metadata, nullptr, false);
  // Metadata that are not JSON after all are shown as they are.
  if (report["metadata"].is_discarded()) report["metadata"] = file.metadata;
  return report;
}

Json as_json(const std::vector<LabelFacts>& labels) {
  Json list = Json::array();
  for (const LabelFacts& facts : labels)
    list.push_back({{"label", facts.label},
                    {"volume", facts.volume},
                    {"bounding_box", {facts.bounding_box.min, facts.bounding_box.max}}});
  return list;
}

std::string as_text(const LabelMap& map, const std::vector<LabelFacts>& labels) {
  std::string text =
      fmt::format("  {:<16}{} in {} on the Millar curve, {} in memory\n", "labels", grouped(labels.size()),
                  counted(map.run_count(), "run"), counted(map.memory_bytes(), "byte"));
  for (const auto& [label, volume, box] : labels)
    text += fmt::format("  {:>14}  {}, ({}, {}, {}) to ({}, {}, {})\n", label, counted(volume, "voxel"), box.min[0],
                        box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]);
  return text;
}

std::string as_text(const std::string& name, const OctreeFile& file, const Measures& measures) {
  const Frame& frame = file.octree.frame();
  std::string text = name + "\n";
  const auto line = [&](const char* label, const std::string& value) {
    text += fmt::format("  {:<16}{}\n", label, value);
  };
  line("depth", fmt::format("{} (universe of {} voxels a side)", file.octree.depth(),
                            grouped(static_cast<std::uint64_t>(file.octree.side()))));
  line("volume", grouped(measures.volume) + " voxels");
  line("surface area", grouped(measures.surface_area) + " voxel faces");
  if (measures.bounding_box) {
    const auto& [min, max] = *measures.bounding_box;
    line("bounding box", fmt::format("({}, {}, {}) to ({}, {}, {}), upper end exclusive", min[0], min[1], min[2],
                                     max[0], max[1], max[2]));
  }
  if (measures.centroid) line("centroid", vector_text(*measures.centroid));
  line("black leaves", grouped(measures.black_leaves));
  for (std::size_t level = measures.black_leaves_by_level.size(); level-- > 0;)
    if (measures.black_leaves_by_level[level] > 0)
      line("", fmt::format("{} of side {}", grouped(measures.black_leaves_by_level[level]), std::size_t{1} << level));
  line("white leaves", grouped(measures.white_leaves));
  line("internal nodes", grouped(measures.internal_nodes));
  line("runs", grouped(measures.runs) + " on the Millar curve");
  line("in memory", grouped(file.octree.memory_bytes()) + " bytes");
  line("on disk", grouped(file.file_bytes) + " bytes");
  line("frame", fmt::format("origin {}, unit: {}", vector_text(frame.origin), frame.unit));
  for (Eigen::Index i = 0; i < 3; ++i)
    line("", fmt::format("one voxel along {}: {}", "xyz"[i], vector_text(frame.axes.col(i))));
  if (file.metadata != "{}") line("metadata", file.metadata);
  return text;
}

}  // namespace

int run_info(Session& session) {
  std::string input;
  Label label;
  add_octree_input(session.app(), "FILE", input);
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf info bunny.octree --json");
  if (!session.parse()) return kDone;

  OctreeFile file = read_octree(session, input);
  if (label && !file.labels) refuse_label(input);
  if (label) file.octree = session.stage("read", [&](const Work&) { return solid_of(*file.labels, *label, input); });
  const Measures measures = session.stage("measure", [&](const Work&) { return measure(file.octree); });
  std::vector<LabelFacts> labels;
  if (file.labels && !label) labels = session.stage("measure", [&](const Work&) { return label_facts(*file.labels); });
  if (session.json()) {
    Json report = as_json(file, measures);
    if (label) report["label"] = *label;
    if (file.labels && !label) {
      report["label_runs"] = file.labels->run_count();
      report["labels"] = as_json(labels);
    }
    print_out(report);
  } else {
    const std::string name = base_name(input) + (label ? fmt::format(", label {}", *label) : "");
    print_out(as_text(name, file, measures) + (file.labels && !label ? as_text(*file.labels, labels) : ""));
  }
  return kDone;
}

}  // namespace blackleaf::cli
