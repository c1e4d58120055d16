#include "strokes.h"

#include <algorithm>
#include <utility>

#include "octree/parallel.h"

namespace blackleaf::detail {

namespace {

// Calls visit(key, low, high) for each maximal piece, in order.
template <class Visit>
void for_each_united(std::span<const Piece> pieces, const Visit& visit) {
  for (std::size_t i = 0; i < pieces.size();) {
    const std::int64_t key = pieces[i].key, low = pieces[i].low;
    std::int64_t high = pieces[i].high;
    for (++i; i < pieces.size() && pieces[i].key == key && pieces[i].low <= high; ++i)
      high = std::max(high, pieces[i].high);
    visit(key, low, high);
  }
}

// Far from the origin a stroke can be shorter than the doubles tell apart; such a one draws nothing.
bool draws_nothing(const Stroke& stroke) { return stroke.from == stroke.to; }

}  // namespace

void append_strokes(std::span<const Piece> pieces, const PictureLines& picture, std::vector<Stroke>& strokes) {
  for_each_united(pieces, [&](std::int64_t key, std::int64_t low, std::int64_t high) {
    const Stroke stroke{picture.point(key, low), picture.point(key, high)};
    if (!draws_nothing(stroke)) strokes.push_back(stroke);
  });
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
    std::size_t count = 0, first = 0;  // of its strokes
    bool all_draw = true;
  };
  std::vector<Part> parts;
  for (const ClassPieces& of : classes)
    for (std::size_t begin = 0; begin < of.pieces.size();) {
      std::size_t end = std::min(begin + kAtOnce, of.pieces.size());
      while (end < of.pieces.size() && of.pieces[end].key == of.pieces[end - 1].key) ++end;  // whole lines
      parts.push_back({of.pieces.subspan(begin, end - begin), of.picture});
      begin = end;
    }
  const Work quietly{work.threads, {}};
  for_each_index(parts.size(), quietly, [&](std::size_t i) {
    for_each_united(parts[i].pieces, [&](std::int64_t, std::int64_t, std::int64_t) { ++parts[i].count; });
  });
  std::size_t count = 0;
  for (Part& part : parts) part.first = std::exchange(count, count + part.count);
  strokes.resize(count);
  for_each_index(parts.size(), quietly, [&](std::size_t i) {
    Stroke* next = &strokes[parts[i].first];
    for_each_united(parts[i].pieces, [&](std::int64_t key, std::int64_t low, std::int64_t high) {
      *next = {parts[i].picture.point(key, low), parts[i].picture.point(key, high)};
      if (draws_nothing(*next++)) parts[i].all_draw = false;
    });
  });
  if (std::any_of(parts.begin(), parts.end(), [](const Part& part) { return !part.all_draw; }))
    std::erase_if(strokes, draws_nothing);
  return strokes;
}

}  // namespace blackleaf::detail
