#include "ranks_machine.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "blackleaf/error.h"
#include "files.h"
#include "mpi/shared_motion.h"

namespace blackleaf::cli {
namespace {

mpi::SharedOctree shared(const Made& made) { return {made.octree, {made.first, made.last}}; }

std::string in_mebibytes(std::uint64_t bytes) { return fmt::format("{} MiB", (bytes + (1 << 20) - 1) >> 20); }

}  // namespace

Made made_of(const mpi::SharedOctree& octree) { return {octree.own, octree.chunks.first, octree.chunks.last}; }

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  int shift = 0;
  bool good = error == std::errc{} && end - rest <= 1 && value > 0;
  if (good && rest != end) {
    const std::string_view units = "KMGT";
    const std::size_t unit = units.find(*rest);
    good = unit != std::string_view::npos;
    shift = good ? 10 * (static_cast<int>(unit) + 1) : 0;
  }
  if (!good || value > std::numeric_limits<std::uint64_t>::max() >> shift)
    throw Error(ErrorCode::bad_argument, fmt::format("{} is '{}', which is not a number of bytes", option, text),
                "write it like 512M or 4G");
  return value << shift;
}

void RanksMachine::add_options(App& app) {
  app.add_option_function(
         "--memory-limit", [this](const std::string& text) { memory_limit_ = parse_bytes("--memory-limit", text); },
         "bytes that a rank may hold, like 512M or 4G: refuse early what needs more (default: no limit)")
      ->type_name("BYTES")
      ->group("Options of every command");
}

void RanksMachine::once(const std::function<void()>& job) {
  ranks_.meet();
  if (ranks_.first()) job();
  ranks_.meet();
}

OctreeFile RanksMachine::load(const std::string& path) {
  std::vector<std::uint8_t> bytes;
  if (ranks_.first()) {
    if (path != "-") check_octree_input(path);
    bytes = read_bytes(path);
  }
  return mpi::load(ranks_, bytes, path == "-" ? "standard input" : path);
}

void RanksMachine::check_memory(std::uint64_t sources, std::uint64_t copies) const {
  if (memory_limit_ == 0) return;
  // A result has about as many nodes as its sources, a part an eighth more for cuts that are not quite even; it is
  // there twice while it is joined.
  const std::uint64_t part = sources / static_cast<std::uint64_t>(ranks_.size());
  const std::uint64_t needed = sources * (1 + copies) + 2 * (part + part / 8);
  if (needed > memory_limit_)
    throw Error(ErrorCode::bad_argument,
                fmt::format("a rank of {} needs {} for the octrees and its part of the result, and may have {}",
                            ranks_.size(), in_mebibytes(needed), in_mebibytes(memory_limit_)),
                "give more memory, or use more ranks");
}

Made RanksMachine::move(const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion, Leaving leaving,
                        const Work& work) {
  check_memory(octree.memory_bytes(), reflection == LatticeSymmetry() ? 0 : 1);
  return made_of(mpi::move(ranks_, octree, reflection, motion, leaving, work));
}

Made RanksMachine::translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                             const Work& work) {
  check_memory(octree.memory_bytes(), 0);
  return made_of(mpi::translate(ranks_, octree, by, leaving, work));
}

Made RanksMachine::combine(std::span<const Octree> octrees, SetOperation operation, const Work& work) {
  std::uint64_t sources = 0;
  for (const Octree& octree : octrees) sources += octree.memory_bytes();
  check_memory(sources, 0);
  return made_of(mpi::combine(ranks_, octrees, operation, work));
}

bool RanksMachine::is_empty(const Made& made) { return mpi::is_empty(ranks_, shared(made)); }

Told RanksMachine::tell_of(const Made& made) {
  const mpi::Told told = mpi::tell_of(ranks_, shared(made));
  return {told.volume, told.black_leaves, told.internal_nodes, told.memory_bytes};
}

void RanksMachine::write_raw_volume(const Octree& octree, const std::string& path, bool crop) {
  mpi::write_raw_volume(ranks_, octree, path, crop);
}

void RanksMachine::save(const Made& made, const std::string& path, const std::string& metadata) {
  mpi::save(ranks_, shared(made), path, metadata, {});
}

}  // namespace blackleaf::cli
