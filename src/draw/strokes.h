// Strokes: pieces of picture lines united exactly and turned into points of the picture.
#pragma once

#include <vector>

#include "blackleaf/drawing.h"
#include "edge_family.h"

namespace blackleaf::detail {

/// Unites pieces that overlap or touch and appends one stroke for each maximal piece, in order of (key, low).
/// Requires: `pieces` is sorted and belongs to the family's line class.
void append_strokes(const std::vector<Piece>& pieces, const EdgeFamily& family, const View& view,
                    std::vector<Stroke>& strokes);

}  // namespace blackleaf::detail
