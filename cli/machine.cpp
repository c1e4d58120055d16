#include "machine.h"

#include "blackleaf/measures.h"
#include "blackleaf/volume_file.h"
#include "files.h"

namespace blackleaf::cli {

OctreeFile Machine::load(const std::string& path) {
  if (path == "-") return from_bytes(read_bytes(path), "standard input");
  check_octree_input(path);
  return blackleaf::load(path);
}

Made Machine::move(const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion, Leaving leaving,
                   const Work& work) {
  return {blackleaf::move(transform(octree, reflection, work), motion, leaving, work)};
}

Made Machine::translate(const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                        const Work& work) {
  return {blackleaf::translate(octree, by, leaving, work)};
}

Made Machine::combine(std::span<const Octree> octrees, SetOperation operation, const Work& work) {
  return {operation(octrees, work)};
}

Told Machine::tell_of(const Made& made) {
  const Measures measures = measure(made.octree);
  return {measures.volume, measures.black_leaves, measures.internal_nodes, made.octree.memory_bytes()};
}

void Machine::write_raw_volume(const Octree& octree, const std::string& path, bool crop) {
  blackleaf::write_raw_volume(octree, path, crop);
}

void Machine::save(const Made& made, const std::string& path, const std::string& metadata) {
  blackleaf::save(made.octree, path, metadata);
}

}  // namespace blackleaf::cli
