// make_foam DEPTH OUT.octree: a ball with pores, much surface for its volume: the input of the figures mpi/... .
#include <cmath>
#include <cstdlib>

#include "blackleaf/implicit.h"
#include "blackleaf/octree_file.h"

int main(int argc, char** argv) {
  using namespace blackleaf;
  if (argc != 3) return 2;
  const int depth = std::atoi(argv[1]);
  const double side = std::exp2(depth);
  const Octree foam = octree_from_classifier(depth, [side](const Cube& cube) {
    constexpr double kCell = 1.0 / 16, kHalfDiagonal = 0.8660254037844387;
    const double size = cube.side() / side;
    const auto middle = [&](std::int32_t corner) { return corner / side + size / 2; };
    const auto from_pore = [](double v) { return v - (std::floor(v / kCell) + 0.5) * kCell; };
    const double x = middle(cube.x), y = middle(cube.y), z = middle(cube.z);
    // No farther from zero than the surface is from the point.
    const double distance = std::max(std::hypot(x - 0.5, y - 0.5, z - 0.5) - 0.35,
                                     0.4 * kCell - std::hypot(from_pore(x), from_pore(y), from_pore(z)));
    if (cube.level > 0 && std::abs(distance) <= kHalfDiagonal * size) return Colour::gray;
    return distance <= 0 ? Colour::black : Colour::white;
  });
  save(foam, argv[2]);
}
