// Octrees from point clouds. See docs/POINTS.md.
#include "blackleaf/points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/error.h"
#include "octree/brick.h"
#include "octree/parallel.h"
#include "octree/produce.h"
#include "to_universe.h"

namespace blackleaf {
namespace {

// A node is a range of the sorted numbers of black voxels, on the curve of order 2 at least.
struct SortedProducer {
  struct Task {
    std::size_t low, high;  // numbers [low, high)
    std::uint64_t first;    // of the node's first voxel
    std::uint8_t table;     // of the curve in the node
  };
  const std::vector<std::uint64_t>& numbers;

  Task root() const { return {0, numbers.size(), 0, 0}; }
  Colour classify(const Task& task, const Cube& cube) const {
    if (task.low == task.high) return Colour::white;
    return task.high - task.low == std::uint64_t{1} << 3 * cube.level ? Colour::black : Colour::gray;
  }
  Task child(const Task& task, const Cube& cube, int octant) const {
    const curve::Step digit = curve::kDigits[task.table][static_cast<std::size_t>(octant)];
    const std::uint64_t size = std::uint64_t{1} << 3 * cube.level;
    const std::uint64_t first = task.first + digit.octant * size;
    const auto begin = numbers.begin();
    const auto low = std::lower_bound(begin + static_cast<std::ptrdiff_t>(task.low),
                                      begin + static_cast<std::ptrdiff_t>(task.high), first);
    const auto high = std::lower_bound(low, begin + static_cast<std::ptrdiff_t>(task.high), first + size);
    return {static_cast<std::size_t>(low - begin), static_cast<std::size_t>(high - begin), first, digit.table};
  }
  std::uint64_t brick(const Task& task, const Cube&) const {
    std::uint64_t bits = 0;
    for (std::size_t i = task.low; i < task.high; ++i) bits |= std::uint64_t{1} << (numbers[i] - task.first);
    return detail::from_curve_order(bits, task.table);
  }
};

std::string text(const Eigen::Vector3d& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) + ")";
}

}  // namespace

class PointGatherer::Gathered {
 public:
  Gathered(const MeshPlacement& placement, const PointOptions& options, int threads)
      : placement_(placement), options_(options), work_{threads, {}}, to_universe_(placement.frame) {
    if (placement.depth < 1 || placement.depth > kMaxDepth)
      throw Error(ErrorCode::bad_argument, "depth " + std::to_string(placement.depth) + " is out of range",
                  "use 1 to 20");
    if (options.min_points < 1 || options.min_points > kMostCounted)
      throw Error(ErrorCode::bad_argument, std::to_string(options.min_points) + " points a voxel are out of range",
                  "ask for 1 to 2^32 - 1");
  }

  void add(std::span<const Eigen::Vector3d> points) {
    while (!points.empty()) {
      const auto part = points.first(std::min(points.size(), room()));
      number(part);
      points = points.subspan(part.size());
      if (room() == 0) sort_in();
    }
  }

  Octree octree(const Work& work) {
    if (outside > 0 && !options_.clip)
      throw Error(ErrorCode::out_of_universe,
                  std::to_string(outside) + " of " + std::to_string(added) +
                      " points lie outside the universe, the first at " + text(first_outside_),
                  "use a universe that holds them, or clip them");
    sort_in();
    if (options_.min_points == 1)
      return detail::produce(SortedProducer{numbers_}, placement_.depth, placement_.frame, work);
    std::vector<std::uint64_t> enough;
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      if (counts_[i] >= options_.min_points) enough.push_back(numbers_[i]);
    return detail::produce(SortedProducer{enough}, placement_.depth, placement_.frame, work);
  }

  std::uint64_t added = 0, not_finite = 0, outside = 0;

 private:
  static constexpr std::size_t kLeast = std::size_t{1} << 22;  // points held back before they are sorted
  static constexpr std::uint64_t kNotFinite = ~std::uint64_t{0}, kOutside = kNotFinite - 1;  // in place of a number

  static constexpr std::uint64_t kMostCounted = std::numeric_limits<std::uint32_t>::max();

  // As many as there are voxels, so that every point takes part in a number of merges that grows by the logarithm.
  std::size_t room() const { return std::max(kLeast, numbers_.size()) - pending_.size(); }

  std::uint64_t number_of(const Eigen::Vector3d& world) const {
    const Eigen::Vector3d p = to_universe_(world);
    if (!p.allFinite()) return world.allFinite() ? kOutside : kNotFinite;
    const double side = std::ldexp(1.0, placement_.depth);
    if (p.minCoeff() < -detail::kWallTolerance || p.maxCoeff() > side + detail::kWallTolerance) return kOutside;
    const int fraction_bits = 40 - placement_.depth;
    const std::int32_t last = (std::int32_t{1} << placement_.depth) - 1;
    std::array<std::int32_t, 3> voxel{};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t place = std::llround(std::ldexp(std::clamp(p[axis], 0.0, side), fraction_bits));
      voxel[static_cast<std::size_t>(axis)] = std::min(static_cast<std::int32_t>(place >> fraction_bits), last);
    }
    return curve::number(std::max(placement_.depth, 2), {voxel[0], voxel[1], voxel[2]});
  }

  void number(std::span<const Eigen::Vector3d> part) {
    const std::size_t begin = pending_.size();
    pending_.resize(begin + part.size());
    constexpr std::size_t kBlock = 4096;
    detail::for_each_index((part.size() + kBlock - 1) / kBlock, work_, [&](std::size_t block) {
      const std::size_t end = std::min(part.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < end; ++i) pending_[begin + i] = number_of(part[i]);
    });
    added += part.size();
    std::size_t kept = begin;
    for (std::size_t i = begin; i < pending_.size(); ++i) {
      const std::uint64_t number = pending_[i];
      if (number == kNotFinite) {
        ++not_finite;
      } else if (number == kOutside) {
        if (outside++ == 0) first_outside_ = part[i - begin];
      } else {
        pending_[kept++] = number;
      }
    }
    pending_.resize(kept);
  }

  // Merges what is pending into the sorted numbers and, if they are asked for, counts.
  void sort_in() {
    if (pending_.empty()) return;
    detail::sort(pending_, work_);
    const bool counting = options_.min_points > 1;
    const std::vector<std::uint64_t> old = std::move(numbers_);
    const std::vector<std::uint32_t> old_counts = std::move(counts_);
    numbers_ = {};
    counts_ = {};
    numbers_.reserve(old.size() + distinct(pending_));
    if (counting) counts_.reserve(numbers_.capacity());
    for (std::size_t i = 0, j = 0; i < old.size() || j < pending_.size();) {
      const std::uint64_t next = i == old.size()        ? pending_[j]
                                 : j == pending_.size() ? old[i]
                                                        : std::min(old[i], pending_[j]);
      std::uint64_t count = 0;
      if (i < old.size() && old[i] == next) {
        if (counting) count = old_counts[i];
        ++i;
      }
      for (; j < pending_.size() && pending_[j] == next; ++j) ++count;
      numbers_.push_back(next);
      // More are as good as that many: min_points is no more.
      if (counting) counts_.push_back(static_cast<std::uint32_t>(std::min<std::uint64_t>(count, kMostCounted)));
    }
    pending_.clear();
  }

  static std::size_t distinct(const std::vector<std::uint64_t>& sorted) {
    std::size_t count = sorted.empty() ? 0 : 1;
    for (std::size_t i = 1; i < sorted.size(); ++i) count += sorted[i] != sorted[i - 1];
    return count;
  }

  const MeshPlacement placement_;
  const PointOptions options_;
  const Work work_;
  const detail::ToUniverse to_universe_;
  std::vector<std::uint64_t> numbers_;  // sorted, each once
  std::vector<std::uint32_t> counts_;   // points in each, if min_points asks for more than one
  std::vector<std::uint64_t> pending_;
  Eigen::Vector3d first_outside_ = Eigen::Vector3d::Zero();
};

PointGatherer::PointGatherer(const MeshPlacement& placement, const PointOptions& options, int threads)
    : gathered_(std::make_unique<Gathered>(placement, options, threads)) {}
PointGatherer::~PointGatherer() = default;
PointGatherer::PointGatherer(PointGatherer&&) noexcept = default;
PointGatherer& PointGatherer::operator=(PointGatherer&&) noexcept = default;

void PointGatherer::add(std::span<const Eigen::Vector3d> points) { gathered_->add(points); }
std::uint64_t PointGatherer::points() const { return gathered_->added; }
std::uint64_t PointGatherer::not_finite() const { return gathered_->not_finite; }
std::uint64_t PointGatherer::outside() const { return gathered_->outside; }
Octree PointGatherer::octree(const Work& work) { return gathered_->octree(work); }

Octree octree_from_points(std::span<const Eigen::Vector3d> points, const MeshPlacement& placement,
                          const PointOptions& options, const Work& work) {
  PointGatherer gatherer(placement, options, work.threads);
  gatherer.add(points);
  return gatherer.octree(work);
}

}  // namespace blackleaf
