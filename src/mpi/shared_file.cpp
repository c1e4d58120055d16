#include "shared_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "blackleaf/error.h"
#include "file/atomic_write.h"
#include "file/octree_share.h"
#include "file/solid_chunks.h"
#include "io/raw_nrrd.h"
#include "mpi_file.h"
#include "octree/node_arrays.h"
#include "octree/parallel.h"
#include "octree/storage.h"

namespace blackleaf::mpi {
namespace {

using namespace detail::format;

// An octree as words for another rank: the root's colour, the number of words of each level, the words.
std::vector<std::uint64_t> to_words(const Octree& octree) {
  std::vector<std::uint64_t> words = {static_cast<std::uint64_t>(octree.root().colour())};
  for (int level = 0; level <= kMaxDepth; ++level) words.push_back(octree.words(level).size());
  for (int level = 0; level <= kMaxDepth; ++level) {
    const auto of_level = octree.words(level);
    words.insert(words.end(), of_level.begin(), of_level.end());
  }
  return words;
}

Octree from_words(const std::vector<std::uint64_t>& words, int depth, const Frame& frame) {
  const auto colour = static_cast<Colour>(words[0]);
  if (colour != Colour::gray) return Octree(depth, colour, frame);
  auto tree = std::make_shared<detail::Words>();
  std::size_t at = kMaxDepth + 2;
  for (std::size_t level = 0; level <= kMaxDepth; ++level) {
    const std::size_t count = words[level + 1];
    tree->of_level[level].append(words.data() + at, count);
    tree->levels[level] = tree->of_level[level].data();
    at += count;
  }
  return Octree(std::make_shared<const Octree::Storage>(Octree::Storage{depth, colour, std::move(tree), frame}));
}

constexpr std::uint64_t up_to_chunk(std::uint64_t number, std::uint64_t chunk) {
  return (number + chunk - 1) / chunk * chunk;
}

struct Counts {
  std::array<std::uint64_t, kMaxDepth + 1> black{}, gray{};

  void add(const Node& node) {
    const auto level = static_cast<std::size_t>(node.level());
    if (node.is_black()) {
      ++black[level];
    } else if (node.is_gray()) {
      ++gray[level];
      if (level == 1)
        black[0] += static_cast<unsigned>(std::popcount(node.word()));
      else
        for (int octant = 0; octant < 8; ++octant) add(node.child(octant));
    }
  }
};

// The nodes above the chunks, from the chunks' colours in curve order: adds them, and returns the node's colour.
Colour add_above(std::span<const std::uint64_t> colours, int level, Counts& counts) {
  if (colours.size() == 1) return static_cast<Colour>(colours.front());
  std::array<Colour, 8> children;
  for (std::size_t i = 0; i < 8; ++i)
    children[i] = add_above(colours.subspan(i * (colours.size() / 8), colours.size() / 8), level - 1, counts);
  const bool same = std::all_of(children.begin(), children.end(), [&](Colour c) { return c == children[0]; });
  if (same && children[0] != Colour::gray) return children[0];
  ++counts.gray[static_cast<std::size_t>(level)];
  counts.black[static_cast<std::size_t>(level - 1)] +=
      static_cast<std::uint64_t>(std::count(children.begin(), children.end(), Colour::black));
  return Colour::gray;
}

// The first rank makes a file under a temporary name, those who have something to write do, and when all is on disk the
// file takes its name.
template <class Write>
void write_together(Ranks& ranks, const std::filesystem::path& path, bool writes, const Write& write) {
  std::optional<detail::AtomicFile> file;
  std::vector<std::uint8_t> name;
  if (ranks.first()) {
    file.emplace(path);
    const std::string text = file->temporary().string();
    name.assign(text.begin(), text.end());
  }
  ranks.broadcast(name);
  if (writes) {
    const MpiFile shared({name.begin(), name.end()}, path, MpiFile::Mode::write);
    write(shared);
    shared.sync();
  }
  ranks.meet();
  if (file) file->commit();
  ranks.meet();
}

}  // namespace

SharedOctree by_chunks(Ranks& ranks, const Octree& part, const Cuts& cuts) {
  const std::uint64_t chunk = chunk_voxels(part.depth());
  const Stretch mine = stretch_of(cuts, ranks.rank());
  const Stretch held{up_to_chunk(mine.first, chunk), up_to_chunk(mine.last, chunk)};
  // What lies before the first chunk that begins here belongs to another.
  const Stretch away{mine.first, std::min(mine.last, held.first)};
  std::vector<std::uint64_t> sent;
  int to = -1;
  if (!away.empty()) {
    to = process_at(cuts, away.first / chunk * chunk);
    sent = to_words(part_of(part, away));
  }
  std::vector<int> from;
  for (int other = ranks.rank() + 1; other < ranks.size() && !Stretch{held.first, held.last}.empty(); ++other) {
    const Stretch theirs = stretch_of(cuts, other);
    if (theirs.first >= held.last) break;
    if (!theirs.empty()) from.push_back(other);
  }
  std::vector<Octree> pieces = {away.empty() ? part : part_of(part, {held.first, std::max(held.first, mine.last)})};
  auto received = ranks.exchange(to, sent, from);
  for (std::vector<std::uint64_t>& words : received) {
    pieces.push_back(from_words(words, part.depth(), part.frame()));
    words = {};
  }
  return {join(pieces), held};
}

OctreeFile load(Ranks& ranks, std::vector<std::uint8_t>& bytes, const std::string& name) {
  ranks.broadcast(bytes);
  if (ranks.size() == 1 || !detail::is_shareable(bytes, name)) return from_bytes(bytes, name);
  OctreeFile file = detail::share_from_bytes(
      bytes, name, {static_cast<std::uint64_t>(ranks.rank()), static_cast<std::uint64_t>(ranks.size())});
  std::vector<Octree> parts;
  const bool empty = file.octree.is_empty();
  for (auto& words : ranks.gather(empty ? std::vector<std::uint64_t>() : to_words(file.octree))) {
    if (!words.empty()) parts.push_back(from_words(words, file.octree.depth(), file.octree.frame()));
    std::vector<std::uint64_t>().swap(words);
  }
  if (!parts.empty()) file.octree = join(parts);
  return file;
}

Told tell_of(Ranks& ranks, const SharedOctree& octree) {
  const int depth = octree.own.depth(), level = chunk_level(depth);
  const std::vector<Node> nodes = detail::chunk_nodes(octree.own);
  const std::uint64_t chunk = chunk_voxels(depth);
  Counts counts;
  std::vector<std::uint64_t> colours(chunk_count(depth), 0);
  if (chunk_count(depth) == 1) {
    if (!octree.chunks.empty()) {
      counts.add(octree.own.root());
      colours[0] = static_cast<std::uint64_t>(octree.own.root().colour());
    }
  } else {
    for (std::uint64_t i = octree.chunks.first / chunk; i < octree.chunks.last / chunk; ++i) {
      const Node& node = nodes[i];
      colours[i] = static_cast<std::uint64_t>(node.colour());
      counts.add(node);
    }
  }
  ranks.sum(counts.black);
  ranks.sum(counts.gray);
  ranks.sum(colours);
  const bool several = colours.size() > 1;
  if (several) {
    // Black chunks are leaves unless their parents are black.
    counts.black[static_cast<std::size_t>(level)] = 0;
    if (add_above(colours, depth, counts) == Colour::black) ++counts.black[static_cast<std::size_t>(depth)];
  }
  Told told;
  std::uint64_t words = 0;
  for (std::size_t k = 0; k <= kMaxDepth; ++k) {
    told.black_leaves += counts.black[k];
    told.volume += counts.black[k] << (3 * k);
    told.internal_nodes += counts.gray[k];
    if (k >= 2 || depth == 1) words += counts.gray[k];
  }
  told.memory_bytes = Octree(depth).memory_bytes();
  if (words > 0) told.memory_bytes += sizeof(detail::Words) + words * sizeof(std::uint64_t);
  return told;
}

bool is_empty(Ranks& ranks, const SharedOctree& octree) { return ranks.largest(octree.own.is_empty() ? 0 : 1) == 0; }

void save(Ranks& ranks, const SharedOctree& octree, const std::filesystem::path& path, const std::string& metadata,
          const Work& work) {
  const int depth = octree.own.depth();
  check_arguments(octree.own.frame(), metadata);
  const std::vector<Node> nodes = detail::chunk_nodes(octree.own);
  const std::uint64_t voxels = chunk_voxels(depth);
  const std::size_t begin = octree.chunks.first / voxels,
                    end = octree.chunks.empty() ? begin : octree.chunks.last / voxels;
  std::vector<Chunk> chunks(end - begin);
  detail::for_each_index(chunks.size(), one_thread_for_one(work, chunks.size()),
                         [&](std::size_t i) { chunks[i] = detail::solid_chunk(nodes[begin + i]); });
  // Kind, colour, bytes and checksum of every chunk.
  std::vector<std::uint64_t> table(4 * chunk_count(depth), 0);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const ChunkEntry entry = entry_of(chunks[i]);
    std::uint64_t* const row = &table[4 * (begin + i)];
    row[0] = static_cast<std::uint64_t>(entry.kind);
    row[1] = entry.colour;
    row[2] = entry.stored_bytes;
    row[3] = entry.checksum;
  }
  ranks.sum(table);
  std::vector<ChunkEntry> entries(chunk_count(depth));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].kind = static_cast<ChunkKind>(table[4 * i]);
    entries[i].colour = static_cast<std::uint32_t>(table[4 * i + 1]);
    entries[i].stored_bytes = table[4 * i + 2];
    entries[i].checksum = table[4 * i + 3];
  }
  const std::vector<std::uint8_t> header = header_bytes(Content::solid, depth, octree.own.frame(), metadata, entries);

  write_together(ranks, path, ranks.first() || !chunks.empty(), [&](const MpiFile& file) {
    if (ranks.first()) file.write_at(0, header);
    std::uint64_t at = header.size();
    for (std::size_t i = 0; i < begin; ++i) at += entries[i].stored_bytes;
    for (const Chunk& chunk : chunks) {
      file.write_at(at, chunk.contents);
      at += chunk.contents.size();
    }
  });
}

void write_raw_volume(Ranks& ranks, const Octree& octree, const std::filesystem::path& path, bool crop) {
  const detail::RawNrrd volume(octree, path, crop);
  const auto share = [&](int rank) { return volume.slices() * rank / ranks.size(); };
  const std::int64_t first = share(ranks.rank()), last = share(ranks.rank() + 1);
  write_together(ranks, path, ranks.first() || first < last, [&](const MpiFile& file) {
    const std::string& header = volume.header();
    if (ranks.first()) file.write_at(0, std::span(reinterpret_cast<const std::uint8_t*>(header.data()), header.size()));
    volume.write_slices(first, last, [&](std::uint64_t offset, std::span<const std::uint8_t> part) {
      ranks.look_out();
      file.write_at(offset, part);
    });
  });
}

}  // namespace blackleaf::mpi
