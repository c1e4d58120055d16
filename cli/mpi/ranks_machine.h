// RanksMachine: the commands of blackleaf, done by the ranks of an MPI program together.
#pragma once

#include "machine.h"
#include "mpi/ranks.h"
#include "mpi/shared_file.h"
#include "session.h"

namespace blackleaf::cli {

class RanksMachine final : public Machine {
 public:
  explicit RanksMachine(mpi::Ranks& ranks) : ranks_(ranks) {}

  mpi::Ranks& ranks() const { return ranks_; }
  /// --memory-limit in bytes, 0 if not given.
  std::uint64_t memory_limit() const { return memory_limit_; }

  bool speaks() const override { return ranks_.first(); }
  bool is_shared() const override { return true; }
  void add_options(App& app) override;
  void look_out() override { ranks_.look_out(); }
  void once(const std::function<void()>& job) override;

  OctreeFile load(const std::string& path) override;
  Made move(const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion, Leaving leaving,
            const Work& work) override;
  Made translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                 const Work& work) override;
  Made combine(std::span<const Octree> octrees, SetOperation operation, const Work& work) override;

  bool is_empty(const Made& made) override;
  Told tell_of(const Made& made) override;
  void write_raw_volume(const Octree& octree, const std::string& path, bool crop) override;
  void save(const Made& made, const std::string& path, const std::string& metadata) override;

 private:
  // Throws Error(bad_argument) if a rank needs more than the limit: sources and its part of the result.
  void check_memory(std::uint64_t sources, std::uint64_t copies) const;

  mpi::Ranks& ranks_;
  std::uint64_t memory_limit_ = 0;
};

Made made_of(const mpi::SharedOctree& octree);

/// build, of volumes.
int run_shared_build(Session& session, RanksMachine& machine);

/// "64M", "2G", "512K" or plain bytes. Throws Error(bad_argument).
std::uint64_t parse_bytes(const std::string& option, const std::string& text);

}  // namespace blackleaf::cli
