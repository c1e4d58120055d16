// The objects of VA88's Figures 5 to 11, by their silhouettes. The paper gives their shapes but no measures: those here
// are ours.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/silhouettes.h"

namespace blackleaf::cli {

struct Va88Object {
  int figure;                           // 5 to 11
  std::string name;                     // e.g. "cylinder"
  std::vector<Silhouette> silhouettes;  // side x side pixels of one voxel; views that see the same have equal pixels
};

inline constexpr int kVa88FirstFigure = 5, kVa88LastFigure = 11;

/// The object of one figure in a universe of depth `depth`. Requires: figure in 5..11, depth in 1..7.
Va88Object va88_object(int figure, int depth = 7);

}  // namespace blackleaf::cli
