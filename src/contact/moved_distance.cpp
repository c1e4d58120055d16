// Distances from a moved solid and from points.
#include <algorithm>
#include <cassert>

#include "blackleaf/distance.h"
#include "box_tree.h"
#include "moved_boxes.h"
#include "nearest_pair.h"
#include "octree/parallel.h"
#include "same_depth.h"

namespace blackleaf {
namespace {

std::optional<MovedDistance> nearest(const PreparedSolid& a, const PreparedSolid& b, const Motion& motion, double below,
                                     double enough) {
  detail::require_same_depth(a, b);
  if (a.is_empty() || b.is_empty()) return std::nullopt;
  const detail::MovedBoxes moved(motion);
  detail::NearestPair pair(detail::boxes(a), detail::boxes(b), moved.map());
  const auto closed = [&](const detail::BoxNode& p, const detail::BoxNode& q, double) { return moved.touch(p, q); };
  if (!pair.find(below, enough, closed)) return std::nullopt;
  const detail::NearestPoints& best = pair.best();
  return MovedDistance{best.distance, best.on_a, best.on_b};
}

// The nearest point in a box tree.
class Seeker {
 public:
  Seeker(const detail::BoxTree& tree, const Eigen::Vector3d& point) : tree_(tree), point_(point) {}

  ClosestPoint seek() {
    visit(tree_.root(), squared(tree_.nodes[tree_.root()]));
    const detail::BoxNode& box = tree_.nodes[best_];
    const Eigen::Vector3d centre = detail::centre_of(box), half = detail::half_of(box);
    ClosestPoint result;
    result.point = point_.cwiseMax(centre - half).cwiseMin(centre + half);
    result.voxels = (result.point - point_).norm();
    return result;
  }

 private:
  struct Candidate {
    double squared;
    std::uint32_t node;
  };

  double squared(const detail::BoxNode& box) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double gap =
          std::max(0.0, std::abs(point_[static_cast<Eigen::Index>(i)] - double{box.centre[i]}) - double{box.half[i]});
      sum += gap * gap;
    }
    return sum;
  }

  void visit(std::uint32_t node, double bound) {
    if (bound >= least_) return;
    const detail::BoxNode& box = tree_.nodes[node];
    if (box.is_leaf()) {
      least_ = bound;
      best_ = node;
      return;
    }
    std::array<Candidate, 8> below;
    std::size_t count = 0;
    for (std::uint32_t child = box.first(); child < box.first() + box.count(); ++child) {
      const Candidate next{squared(tree_.nodes[child]), child};
      if (next.squared >= least_) continue;
      std::size_t at = count++;
      for (; at > 0 && next.squared < below[at - 1].squared; --at) below[at] = below[at - 1];
      below[at] = next;
    }
    for (std::size_t i = 0; i < count; ++i) visit(below[i].node, below[i].squared);
  }

  const detail::BoxTree& tree_;
  Eigen::Vector3d point_;
  double least_ = std::numeric_limits<double>::infinity();
  std::uint32_t best_ = 0;
};

}  // namespace

std::optional<MovedDistance> distance(const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b,
                                      double up_to) {
  // The limit itself is included.
  return nearest(a, b, motion_of_b, std::nextafter(up_to, std::numeric_limits<double>::infinity()), 0);
}

std::optional<MovedDistance> distance(const Octree& a, const Octree& b, const Motion& motion_of_b, double up_to) {
  return distance(PreparedSolid(a), PreparedSolid(b), motion_of_b, up_to);
}

std::vector<std::optional<MovedDistance>> distances(const PreparedSolid& a, const PreparedSolid& b,
                                                    std::span<const Motion> motions_of_b, const Work& work) {
  detail::require_same_depth(a, b);
  std::vector<std::optional<MovedDistance>> results(motions_of_b.size());
  detail::for_each_index(results.size(), work, [&](std::size_t i) { results[i] = distance(a, b, motions_of_b[i]); });
  return results;
}

bool farther_than(double voxels, const PreparedSolid& a, const PreparedSolid& b, const Motion& motion_of_b) {
  assert(voxels >= 0);
  return !nearest(a, b, motion_of_b, std::nextafter(voxels, std::numeric_limits<double>::infinity()), voxels);
}

std::optional<ClosestPoint> closest(const PreparedSolid& solid, const Eigen::Vector3d& point) {
  assert(point.allFinite());
  if (solid.is_empty()) return std::nullopt;
  return Seeker(detail::boxes(solid), point).seek();
}

std::optional<ClosestPoint> closest(const Octree& solid, const Eigen::Vector3d& point) {
  return closest(PreparedSolid(solid), point);
}

std::vector<ClosestPoint> closest(const PreparedSolid& solid, std::span<const Eigen::Vector3d> points,
                                  const Work& work) {
  if (solid.is_empty()) return {};
  std::vector<ClosestPoint> results(points.size());
  constexpr std::size_t kBatch = 256;
  detail::for_each_index((points.size() + kBatch - 1) / kBatch, work, [&](std::size_t batch) {
    for (std::size_t i = batch * kBatch; i < std::min(points.size(), (batch + 1) * kBatch); ++i)
      results[i] = *closest(solid, points[i]);
  });
  return results;
}

}  // namespace blackleaf
