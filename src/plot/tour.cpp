#include "plot/tour.h"

#include <algorithm>
#include <array>
#include <limits>

#include "plot/end_tree.h"

namespace blackleaf::detail {
namespace {

// Up to here all orders and directions are looked at; the table of partial tours has 2n 2^n rows.
constexpr std::size_t kFewChains = 9;

double distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return (a - b).norm(); }

const Eigen::Vector2d& entry(std::span<const Ends> chains, Visit visit) {
  return visit.reversed ? chains[visit.chain].last : chains[visit.chain].first;
}
const Eigen::Vector2d& leaving(std::span<const Ends> chains, Visit visit) {
  return visit.reversed ? chains[visit.chain].first : chains[visit.chain].last;
}

// The shortest tour: for each set of chains drawn and each last visit, the shortest way there.
std::vector<Visit> shortest_tour(std::span<const Ends> chains, const Eigen::Vector2d& start) {
  struct Row {
    double length = std::numeric_limits<double>::infinity();
    std::size_t before = 0;  // the visit before the last: 2 chain + reversed
  };
  const std::size_t visits = 2 * chains.size(), sets = std::size_t{1} << chains.size();
  const auto visit = [](std::size_t index) { return Visit{static_cast<std::uint32_t>(index / 2), index % 2 == 1}; };
  std::vector<Row> rows(sets * visits);
  for (std::size_t set = 1; set < sets; ++set)
    for (std::size_t last = 0; last < visits; ++last) {
      const std::size_t bit = std::size_t{1} << last / 2;
      if ((set & bit) == 0) continue;
      Row& row = rows[set * visits + last];
      const Eigen::Vector2d& at = entry(chains, visit(last));
      if (set == bit) {
        row.length = distance(start, at);
        continue;
      }
      for (std::size_t before = 0; before < visits; ++before) {
        if (before / 2 == last / 2) continue;
        const double length = rows[(set ^ bit) * visits + before].length + distance(leaving(chains, visit(before)), at);
        if (length < row.length) row = {length, before};
      }
    }
  std::vector<Visit> tour(chains.size());
  std::size_t set = sets - 1, last = 0;
  for (std::size_t i = 1; i < visits; ++i)
    if (rows[set * visits + i].length < rows[set * visits + last].length) last = i;
  for (std::size_t i = tour.size(); i-- > 0;) {
    tour[i] = visit(last);
    const std::size_t before = rows[set * visits + last].before;
    set ^= std::size_t{1} << last / 2;
    last = before;
  }
  return tour;
}

std::vector<Eigen::Vector2d> points_of(std::span<const Ends> chains) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(2 * chains.size());
  for (const Ends& chain : chains) {
    points.push_back(chain.first);
    points.push_back(chain.last);
  }
  return points;
}

// 2-opt and Or-opt on an array of visits. An *end* is 2 chain for the first point of a chain, 2 chain + 1 for its last;
// a visit is the end by which it enters.
class Improver {
 public:
  Improver(std::span<const Ends> chains, const Eigen::Vector2d& start, const std::vector<Visit>& tour)
      : points_(points_of(chains)), start_(start), place_(tour.size()), waiting_(points_.size(), false) {
    for (const Visit visit : tour) tour_.push_back(2 * visit.chain + (visit.reversed ? 1 : 0));
    note_places(0, tour_.size());
    const EndTree tree(points_);
    near_.resize(points_.size() * kNear);
    std::vector<std::pair<double, std::uint32_t>> found;
    for (std::uint32_t end = 0; end < points_.size(); ++end) {
      tree.nearest(points_[end], kNear, end, end ^ 1, found);
      for (std::size_t k = 0; k < kNear; ++k)
        near_[end * kNear + k] = k < found.size() ? found[k].second : end;  // `end` itself: no more
    }
  }

  void run() {
    for (std::size_t i = 0; i < tour_.size(); ++i) {
      await(left(i));
      await(right(i));
    }
    // Every move shortens the tour by more than rounding, so this ends.
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const std::uint32_t end = queue_[next];
      waiting_[end] = false;
      while (improve_at(end)) {
      }
      if (next >= kCompact) {
        queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(next + 1));
        next = static_cast<std::size_t>(-1);
      }
    }
  }

  std::vector<Visit> tour() const {
    std::vector<Visit> tour;
    for (const std::uint32_t end : tour_) tour.push_back({end / 2, end % 2 == 1});
    return tour;
  }

 private:
  static constexpr std::size_t kNear = 8;
  static constexpr std::size_t kCompact = 1 << 20;
  static constexpr std::size_t kLongestPiece = 3;  // that an Or-opt move takes elsewhere
  // Visits that a move may shift; longer moves gain little and cost their length.
  static constexpr std::size_t kFarthest = 25000;
  static constexpr double kLeastGain = 1e-7;  // millimetres

  struct Move {
    double gain = kLeastGain;
    std::size_t begin = 0, end = 0;  // the visits [begin, end) ...
    std::size_t to = 0;              // ... go before this one, if it is none of them,
    bool turned = false;             // in the reverse order and direction
  };

  std::uint32_t left(std::size_t i) const { return tour_[i]; }
  std::uint32_t right(std::size_t i) const { return left(i) ^ 1; }
  const Eigen::Vector2d& before(std::size_t i) const { return i == 0 ? start_ : points_[right(i - 1)]; }
  // The way from p to visit i, which may be the tour's end.
  double way(const Eigen::Vector2d& p, std::size_t i) const {
    return i == tour_.size() ? 0 : distance(p, points_[left(i)]);
  }

  void await(std::uint32_t end) {
    if (waiting_[end]) return;
    waiting_[end] = true;
    queue_.push_back(end);
  }

  // The reversal of [begin, end).
  void consider_reversal(std::size_t begin, std::size_t end, Move& best) const {
    if (end - begin > kFarthest) return;
    const Eigen::Vector2d& from = before(begin);
    const Eigen::Vector2d& first = points_[left(begin)];
    const Eigen::Vector2d& last = points_[right(end - 1)];
    const double gain = distance(from, first) + way(last, end) - distance(from, last) - way(first, end);
    if (gain > best.gain) best = {gain, begin, end, begin, true};
  }

  // The visits [begin, end) between `to` - 1 and `to`.
  void consider_shift(std::size_t begin, std::size_t end, std::size_t to, bool turned, Move& best) const {
    if (std::max(end, to) - std::min(begin, to) > kFarthest) return;
    const Eigen::Vector2d& first = points_[turned ? right(end - 1) : left(begin)];
    const Eigen::Vector2d& last = points_[turned ? left(begin) : right(end - 1)];
    const Eigen::Vector2d& from = before(begin);
    const double freed = distance(from, points_[left(begin)]) + way(points_[right(end - 1)], end) - way(from, end);
    const double paid = distance(before(to), first) + way(last, to) - way(before(to), to);
    if (freed - paid > best.gain) best = {freed - paid, begin, end, to, turned};
  }

  // Finds and makes the best move that brings `end` beside one of its near ends. False if there is none.
  bool improve_at(std::uint32_t end) {
    const std::size_t i = place_[end / 2];
    const bool at_right = end == right(i);
    const Eigen::Vector2d& p = points_[end];
    const std::size_t gap_before = at_right ? i + 1 : i;  // the gap beside `end` lies before this visit
    const double gap = at_right ? way(p, i + 1) : distance(before(i), p);
    Move best;
    for (std::size_t k = 0; k < kNear; ++k) {
      const std::uint32_t near = near_[end * kNear + k];
      if (near == end || distance(p, points_[near]) >= gap) break;
      const std::size_t j = place_[near / 2];
      const bool near_right = near == right(j);
      if (at_right && near_right)
        consider_reversal(std::min(i, j) + 1, std::max(i, j) + 1, best);
      else if (!at_right && !near_right)
        consider_reversal(std::min(i, j), std::max(i, j), best);
      for (std::size_t length = 1; length <= kLongestPiece; ++length) {
        // A piece of the tour that has `near` at one end, and not `end` nor the gap in it or at its sides.
        if (near_right ? j + 1 < length : j + length > tour_.size()) break;
        const std::size_t from = near_right ? j + 1 - length : j;
        const std::size_t to = from + length;
        if ((from <= i && i < to) || gap_before == from || gap_before == to) break;
        consider_shift(from, to, gap_before, near_right == at_right, best);
      }
    }
    if (best.end == best.begin) return false;
    make(best);
    return true;
  }

  void make(const Move& move) {
    const auto at = [&](std::size_t i) { return tour_.begin() + static_cast<std::ptrdiff_t>(i); };
    if (move.turned) {
      std::reverse(at(move.begin), at(move.end));
      for (std::size_t i = move.begin; i < move.end; ++i) tour_[i] ^= 1;
    }
    std::size_t low = move.begin, high = move.end;
    if (move.to < move.begin) {
      low = move.to;
      std::rotate(at(move.to), at(move.begin), at(move.end));
    } else if (move.to > move.end) {
      high = move.to;
      std::rotate(at(move.begin), at(move.end), at(move.to));
    }
    note_places(low, high);
    // The new gaps lie at the sides of what moved and where it was taken out.
    const std::size_t length = move.end - move.begin;
    for (const std::size_t gap : {low, low + length, high - length, high}) {
      if (gap > 0) await(right(gap - 1));
      if (gap < tour_.size()) await(left(gap));
    }
  }

  void note_places(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) place_[tour_[i] / 2] = static_cast<std::uint32_t>(i);
  }

  std::vector<Eigen::Vector2d> points_;  // by end
  Eigen::Vector2d start_;
  std::vector<std::uint32_t> tour_;   // visits
  std::vector<std::uint32_t> place_;  // of a chain in the tour
  std::vector<std::uint32_t> near_;   // kNear a end, the nearest first
  std::vector<bool> waiting_;         // in the queue
  std::vector<std::uint32_t> queue_;
};

}  // namespace

double travel(std::span<const Ends> chains, const Eigen::Vector2d& start, std::span<const Visit> tour) {
  double sum = 0;
  Eigen::Vector2d at = start;
  for (const Visit visit : tour) {
    sum += distance(at, entry(chains, visit));
    at = leaving(chains, visit);
  }
  return sum;
}

std::vector<Visit> nearest_neighbour_tour(std::span<const Ends> chains, const Eigen::Vector2d& start) {
  const std::vector<Eigen::Vector2d> points = points_of(chains);
  EndTree tree(points);
  std::vector<Visit> tour;
  tour.reserve(chains.size());
  Eigen::Vector2d at = start;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const std::uint32_t end = tree.nearest(at);
    tree.remove(end);
    tree.remove(end ^ 1);
    tour.push_back({end / 2, end % 2 == 1});
    at = points[end ^ 1];
  }
  return tour;
}

void improve(std::span<const Ends> chains, const Eigen::Vector2d& start, std::vector<Visit>& tour) {
  if (tour.size() < 2) return;
  // Numbered as they come in the tour: what is near on the page is near in memory then.
  std::vector<Ends> in_order;
  std::vector<Visit> visits;
  for (const Visit visit : tour) {
    visits.push_back({static_cast<std::uint32_t>(in_order.size()), visit.reversed});
    in_order.push_back(chains[visit.chain]);
  }
  Improver improver(in_order, start, visits);
  improver.run();
  std::vector<Visit> better = improver.tour();
  for (Visit& visit : better) visit.chain = tour[visit.chain].chain;
  tour = std::move(better);
}

std::vector<Visit> short_tour(std::span<const Ends> chains, const Eigen::Vector2d& start) {
  if (chains.size() <= kFewChains) return shortest_tour(chains, start);
  std::vector<Visit> tour = nearest_neighbour_tour(chains, start);
  improve(chains, start, tour);
  return tour;
}

}  // namespace blackleaf::detail
