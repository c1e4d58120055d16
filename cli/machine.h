// Machine: who works on a command, one process or the ranks of blackleaf-mpi together. The commands are the same for
// both; what is done in another way is asked of the machine.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "app.h"
#include "blackleaf/lattice.h"
#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "blackleaf/octree_file.h"
#include "blackleaf/work.h"

namespace blackleaf::cli {

/// An octree that a command has made: all of it, or what this process holds of it, which is all of the numbers [first,
/// last) of the curve.
struct Made {
  Octree octree;
  std::uint64_t first = 0, last = 0;
};

/// What is told of an octree that was made.
struct Told {
  std::uint64_t volume = 0, black_leaves = 0, internal_nodes = 0, memory_bytes = 0;
};

/// A set operation of two octrees or more.
using SetOperation = Octree (*)(std::span<const Octree>, const Work&);

/// One process; the ranks override everything.
class Machine {
 public:
  Machine() = default;
  virtual ~Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// True for the process that prints.
  virtual bool speaks() const { return true; }
  /// True if others work on the same command.
  virtual bool is_shared() const { return false; }
  /// Declares options that only this machine has.
  virtual void add_options(App&) {}
  /// Asked now and then during long work: throws when others have given up.
  virtual void look_out() {}
  /// Does what only one process may do; the others wait for it.
  virtual void once(const std::function<void()>& job) { job(); }

  /// An octree file, for all processes.
  virtual OctreeFile load(const std::string& path);
  virtual Made move(const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion, Leaving leaving,
                    const Work& work);
  virtual Made translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                         const Work& work);
  virtual Made combine(std::span<const Octree> octrees, SetOperation operation, const Work& work);

  /// Of the whole octree, whatever this process holds of it.
  virtual bool is_empty(const Made& made) { return made.octree.is_empty(); }
  virtual Told tell_of(const Made& made);
  /// The raw volume of an octree that every process has.
  virtual void write_raw_volume(const Octree& octree, const std::string& path, bool crop);
  virtual void save(const Made& made, const std::string& path, const std::string& metadata);
};

}  // namespace blackleaf::cli
