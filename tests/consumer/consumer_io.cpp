#include <blackleaf/implicit.h>
#include <blackleaf/mesh.h>
#include <blackleaf/mesh_file.h>
#include <blackleaf/volume_file.h>

#include <cstdio>

int main() {
  using namespace blackleaf;
  const Octree stone = ball(4, {8, 8, 8}, 5);
  write_mesh(boundary_mesh(stone), "stone.ply");
  write_volume(stone, "stone.nrrd");
  const bool volume_kept = read_volume("stone.nrrd") == stone;
  const bool mesh_kept = octree_from_mesh(read_mesh("stone.ply"), {4, stone.frame()}) == stone;
  std::printf("volume kept %d, mesh kept %d\n", volume_kept, mesh_kept);
  return volume_kept && mesh_kept ? 0 : 1;
}
