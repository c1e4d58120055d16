// Which triangles come near a box, in floating point: some that do not may be said to, none that does is left out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid_mesh.h"

namespace blackleaf::detail {

class TriangleBoxes {
 public:
  TriangleBoxes(const GridMesh& mesh, const std::vector<Triangle>& triangles);

  std::uint32_t size() const { return static_cast<std::uint32_t>(triangles_.size()); }
  /// False only if triangle i does not meet the closed box about `centre` of half the side `half`, in voxels.
  bool near(std::uint32_t i, const std::array<double, 3>& centre, double half) const;

 private:
  struct Corners {
    std::array<std::array<double, 3>, 3> p;  // voxels
    std::array<double, 3> normal;
  };
  std::vector<Corners> triangles_;
};

}  // namespace blackleaf::detail
