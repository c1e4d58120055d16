// The slow readable twin of strokes_of(): all pieces of a line class sorted, then united one after the other.
#pragma once

#include <algorithm>
#include <vector>

#include "blackleaf/drawing.h"
#include "draw/strokes.h"

namespace blackleaf::reference {

/// Appends one stroke for each maximal piece, in order of (key, low), but those too short for doubles to tell their
/// ends apart. Requires: the pieces belong to the line class.
inline void append_strokes(std::vector<detail::Piece> pieces, const detail::PictureLines& picture,
                           std::vector<Stroke>& strokes) {
  std::sort(pieces.begin(), pieces.end());
  std::vector<detail::Piece> united;
  for (const detail::Piece& piece : pieces)
    if (!united.empty() && united.back().key == piece.key && piece.low <= united.back().high)
      united.back().high = std::max(united.back().high, piece.high);
    else
      united.push_back(piece);
  for (const detail::Piece& piece : united) {
    const Stroke stroke(picture.point(piece.key, piece.low), picture.point(piece.key, piece.high));
    if (stroke.from != stroke.to) strokes.push_back(stroke);
  }
}

}  // namespace blackleaf::reference
