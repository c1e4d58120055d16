#include <algorithm>
#include <string>
#include <vector>

#include "blackleaf/octree_file.h"
#include "file/atomic_write.h"
#include "file/file_header.h"
#include "file/label_chunks.h"
#include "file/solid_chunks.h"
#include "file/solid_coder.h"
#include "octree/parallel.h"

namespace blackleaf {
using namespace detail::format;

namespace {

// The chunks' nodes below this one, in curve order.
void collect(const Node& node, int chunk_level, unsigned table, std::vector<Node>& chunks) {
  if (node.level() <= chunk_level) {
    chunks.push_back(node);
    return;
  }
  for (const curve::Step step : curve::kSteps[table]) collect(node.child(step.octant), chunk_level, step.table, chunks);
}

}  // namespace

std::vector<Node> detail::chunk_nodes(const Octree& octree) {
  std::vector<Node> nodes;
  // A universe of depth 1 with both colours is written as a brick.
  const Node root = octree.root();
  collect(root.is_gray() ? brick_level_root(octree) : root, std::max(2, chunk_level(octree.depth())), 0, nodes);
  return nodes;
}

Chunk detail::solid_chunk(const Node& node) {
  Chunk chunk;
  if (node.is_gray())
    chunk = {ChunkKind::coded, 0, encode_solid(node)};
  else
    chunk.colour = node.is_black() ? 1 : 0;
  return chunk;
}

std::vector<std::uint8_t> to_bytes(const Octree& octree, const std::string& metadata, const Work& work) {
  check_arguments(octree.frame(), metadata);
  const std::vector<Node> nodes = detail::chunk_nodes(octree);
  std::vector<Chunk> chunks(nodes.size());
  detail::for_each_index(nodes.size(), one_thread_for_one(work, nodes.size()),
                         [&](std::size_t i) { chunks[i] = detail::solid_chunk(nodes[i]); });
  return file_bytes(Content::solid, octree.depth(), octree.frame(), metadata, chunks);
}

std::vector<std::uint8_t> to_bytes(const LabelMap& labels, const std::string& metadata, const Work& work) {
  check_arguments(labels.frame(), metadata);
  const std::uint64_t voxels = chunk_voxels(labels.depth());
  std::vector<Chunk> chunks(chunk_count(labels.depth()));
  detail::for_each_index(chunks.size(), one_thread_for_one(work, chunks.size()), [&](std::size_t chunk) {
    // The runs of the labels' numbers [first, last).
    const std::uint64_t first = chunk * voxels, last = first + voxels;
    const auto starts = labels.starts();
    auto i = static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), first) - starts.begin()) - 1;
    std::vector<Run> runs;
    for (std::uint64_t at = first; at < last; ++i) {
      const std::uint64_t end = std::min(last, starts[i] + labels.count(i));
      runs.push_back({end - at, labels.labels()[i]});
      at = end;
    }
    if (runs.size() == 1)
      chunks[chunk].colour = runs[0].colour;
    else
      chunks[chunk] = {ChunkKind::coded, 0, detail::encode_labels(runs)};
  });
  return file_bytes(Content::labels, labels.depth(), labels.frame(), metadata, chunks);
}

void save(const Octree& octree, const std::filesystem::path& path, const std::string& metadata, const Work& work) {
  detail::write_atomically(path, to_bytes(octree, metadata, work));
}

void save(const LabelMap& labels, const std::filesystem::path& path, const std::string& metadata, const Work& work) {
  detail::write_atomically(path, to_bytes(labels, metadata, work));
}

}  // namespace blackleaf
