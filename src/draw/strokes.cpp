#include "strokes.h"

#include <algorithm>

namespace blackleaf::detail {
void append_strokes(const std::vector<Piece>& pieces, const EdgeFamily& family, const View& view,
                    std::vector<Stroke>& strokes) {
  const PictureLines picture(family, view);
  for (std::size_t i = 0; i < pieces.size();) {
    const std::int64_t key = pieces[i].key, low = pieces[i].low;
    std::int64_t high = pieces[i].high;
    for (++i; i < pieces.size() && pieces[i].key == key && pieces[i].low <= high; ++i)
      high = std::max(high, pieces[i].high);
    const Stroke stroke{picture.point(key, low), picture.point(key, high)};
    // Far from the origin a stroke can be shorter than the doubles tell apart; such a one draws nothing.
    if (stroke.from != stroke.to) strokes.push_back(stroke);
  }
}

}  // namespace blackleaf::detail
