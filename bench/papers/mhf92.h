// MHF92: R. J. Millar, M. E. C. Hull and J. H. Frazer, "The Millar Polyhedron and its use in the construction of
// octrees", 1992, as printed.
//
// Node numbers become coordinates by table look-ups, one table a level, for every voxel anew (section 2.2); the walk
// emits (count, datum) tuples (section 4); the tuples are cut to cubic numbers, and the octree's nodes are formed from
// them bottom-up in one pass (section 3).
//
// This is the paper's own algorithm, kept as a second witness and as a baseline. The libraries do not use it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "blackleaf/octree.h"
#include "papers/mhf92_tables.h"
#include "papers/node_pool.h"

namespace blackleaf::papers::mhf92 {

struct Coordinates {
  std::uint32_t x = 0, y = 0, z = 0;
  friend bool operator==(const Coordinates&, const Coordinates&) = default;
};

/// Section 2.2. Requires: 1 <= order <= 20, number < 8^order. `tables` is for showing what the slip does.
Coordinates node_no_to_xyz(int order, std::uint64_t number, const Tables& tables = kTables);
/// Section 2.3, by the converse tables. Requires: coordinates below 2^order.
std::uint64_t xyz_to_node_no(int order, const Coordinates& at);

/// An entry of the data stream: so many voxels of one datum.
struct Tuple {
  std::uint64_t count = 0;
  std::uint32_t datum = 0;
  friend bool operator==(const Tuple&, const Tuple&) = default;
};

/// walkround of section 4: the tuples of the nodes first_node to last_node, both included, of the curve of the given
/// order. from_database(x, y, z) gives a voxel's datum. O(voxels * order).
template <class Database>
std::vector<Tuple> walkround(int order, std::uint64_t first_node, std::uint64_t last_node,
                             const Database& from_database) {
  std::vector<Tuple> stream;
  Coordinates at = node_no_to_xyz(order, first_node);
  std::uint32_t last_datum = from_database(at.x, at.y, at.z);
  std::uint64_t count = 1;
  for (std::uint64_t node = first_node + 1; node <= last_node; ++node) {
    at = node_no_to_xyz(order, node);
    const std::uint32_t datum = from_database(at.x, at.y, at.z);
    if (datum == last_datum) {
      ++count;
    } else {
      stream.push_back({count, last_datum});
      count = 1;
      last_datum = datum;
    }
  }
  stream.push_back({count, last_datum});
  return stream;
}

/// data.stream.joiner of section 4: the streams of consecutive stretches as one; where two meet, the last tuple of the
/// one and the first of the other become one if their data are equal.
std::vector<Tuple> data_stream_joiner(std::span<const std::vector<Tuple>> streams);

/// The parallel form of section 4: `processors` threads walk stretches of equal length, the last one up to the end of
/// the curve. Requires: 1 <= processors <= 8^order.
template <class Database>
std::vector<Tuple> walkround_in_parallel(int order, unsigned processors, const Database& from_database) {
  const std::uint64_t nodes = std::uint64_t{1} << (3 * order);
  const std::uint64_t each = nodes / processors;
  std::vector<std::vector<Tuple>> streams(processors);
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < processors; ++i)
      threads.emplace_back([&, i] {
        streams[i] = walkround(order, i * each, (i + 1 == processors ? nodes : (i + 1) * each) - 1, from_database);
      });
  }
  return data_stream_joiner(streams);
}

/// A tuple cut to a cubic number: 8^level voxels.
struct CubicTuple {
  int level = 0;
  std::uint32_t datum = 0;
  friend bool operator==(const CubicTuple&, const CubicTuple&) = default;
};
/// The stream cut to cubic numbers, counting from the start of the walk (section 3).
std::vector<CubicTuple> cubic_numbers(std::span<const Tuple> stream);

/// The octree of many colours that the stream describes: a tree of pointers, formed without temporary nodes.
class Tree {
 public:
  /// Requires: the counts add up to 8^order and neighbours differ.
  Tree(int order, std::span<const Tuple> stream);

  int depth() const { return depth_; }
  std::size_t internal_nodes() const { return pool_->alive(); }
  /// The most internal nodes that ever lived at once: as many as there are, since none is temporary.
  std::size_t peak_internal_nodes() const { return pool_->peak(); }
  std::uint32_t datum(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
  /// The solid of the voxels whose datum is black.
  Octree octree(const std::function<bool(std::uint32_t)>& is_black) const;

 private:
  struct Node;
  struct Link {
    Node* node = nullptr;     // null: a leaf
    std::uint32_t datum = 0;  // of a leaf
  };
  struct Node {
    std::array<Link, 8> child{};  // by octant label
  };

  int depth_;
  std::unique_ptr<NodePool<Node>> pool_ = std::make_unique<NodePool<Node>>();
  Link root_;
};

}  // namespace blackleaf::papers::mhf92
