#include "strokes.h"

#include <algorithm>

#include "octree/parallel.h"

namespace blackleaf::detail {

void append_strokes(std::span<const Piece> pieces, const PictureLines& picture, std::vector<Stroke>& strokes) {
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

std::vector<Stroke> strokes_of(std::span<const ClassPieces> classes, const Work& work) {
  std::vector<Stroke> strokes;
  if (thread_count(work) == 1) {
    std::size_t count = 0;
    for (const ClassPieces& of : classes) count += of.pieces.size();
    strokes.reserve(count);
    for (const ClassPieces& of : classes) append_strokes(of.pieces, of.picture, strokes);
    return strokes;
  }
  constexpr std::size_t kAtOnce = 4096;
  struct Part {
    std::span<const Piece> pieces;
    const PictureLines& picture;
    std::vector<Stroke> strokes{};
  };
  std::vector<Part> parts;
  for (const ClassPieces& of : classes)
    for (std::size_t begin = 0; begin < of.pieces.size();) {
      std::size_t end = std::min(begin + kAtOnce, of.pieces.size());
      while (end < of.pieces.size() && of.pieces[end].key == of.pieces[end - 1].key) ++end;  // whole lines
      parts.push_back({of.pieces.subspan(begin, end - begin), of.picture});
      begin = end;
    }
  for_each_index(parts.size(), {work.threads, {}}, [&](std::size_t i) {
    parts[i].strokes.reserve(parts[i].pieces.size());
    append_strokes(parts[i].pieces, parts[i].picture, parts[i].strokes);
  });
  std::size_t count = 0;
  for (const Part& part : parts) count += part.strokes.size();
  strokes.reserve(count);
  for (const Part& part : parts) strokes.insert(strokes.end(), part.strokes.begin(), part.strokes.end());
  return strokes;
}

}  // namespace blackleaf::detail
