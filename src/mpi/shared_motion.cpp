#include "shared_motion.h"

#include <utility>

#include "motion/move_plan.h"
#include "motion/move_producer.h"
#include "motion/shift_plan.h"
#include "motion/shift_producer.h"
#include "motion/symmetry_producer.h"
#include "produce_part.h"

namespace blackleaf::mpi {
namespace {

template <class Producer>
Cuts cuts_for(Ranks& ranks, const Producer& producer, int depth) {
  return balanced_cuts(producer, depth, ranks.size(), ranks.rank(),
                       [&](std::vector<std::uint64_t>& weights) { ranks.sum(weights); });
}

template <class Producer>
SharedOctree produced(Ranks& ranks, const Producer& producer, int depth, const Frame& frame, const Work& work) {
  const Cuts cuts = cuts_for(ranks, producer, depth);
  return by_chunks(ranks, produce_part(producer, depth, frame, stretch_of(cuts, ranks.rank()), work), cuts);
}

// A producer that gives some octrees' gray nodes away: where any has one, there is work for a set operation.
class AnyGray {
 public:
  using Task = std::vector<Node>;

  explicit AnyGray(std::span<const Octree> octrees) {
    for (const Octree& octree : octrees) root_.push_back(detail::brick_level_root(octree));
  }
  Task root() const { return root_; }
  Task child(const Task& task, const Cube&, int octant) const {
    Task below;
    for (const Node& node : task)
      if (node.is_gray()) below.push_back(node.child(octant));
    return below;
  }
  Colour classify(const Task& task, const Cube&) const {
    for (const Node& node : task)
      if (node.is_gray()) return Colour::gray;
    return Colour::white;
  }

 private:
  Task root_;
};

// An octree that every rank has already.
SharedOctree shared(Ranks& ranks, const Octree& octree) {
  const Cuts cuts = cuts_for(ranks, AnyGray({&octree, 1}), octree.depth());
  return by_chunks(ranks, part_of(octree, stretch_of(cuts, ranks.rank())), cuts);
}

}  // namespace

SharedOctree move(Ranks& ranks, const Octree& octree, const LatticeSymmetry& reflection, const Motion& motion,
                  Leaving leaving, const Work& work) {
  // A relabelled copy of the source: every rank needs all of it, and copying is soon done.
  const Octree source = transform(octree, reflection, {work.threads, {}});
  const detail::MovePlan plan = detail::plan_move(source, motion, leaving);
  if (plan.stays) return shared(ranks, source);
  if (plan.gone) return shared(ranks, Octree(source.depth(), Colour::white, source.frame()));
  const int depth = plan.target.depth;
  if (!plan.lattice) return produced(ranks, detail::MoveProducer(*plan.motion, source, depth), depth, plan.frame, work);
  const auto& [symmetry, by] = *plan.lattice;
  const bool shifts = by != std::array<std::int64_t, 3>{} || depth != source.depth();
  if (!shifts) {
    if (!source.root().is_gray()) return shared(ranks, source.with_frame(plan.frame));
    return produced(ranks, detail::SymmetryProducer(source, symmetry), depth, plan.frame, work);
  }
  const Octree turned = transform(source, symmetry, {work.threads, {}});
  return produced(ranks, detail::ShiftProducer(by, turned, depth), depth, plan.frame, work);
}

SharedOctree translate(Ranks& ranks, const Octree& octree, const std::array<std::int64_t, 3>& by, Leaving leaving,
                       const Work& work) {
  const auto box = bounding_box(octree);
  if (!box) return shared(ranks, octree);
  const detail::ShiftPlan plan = detail::plan_shift(octree.depth(), *box, by, leaving);
  if (plan.gone) return shared(ranks, Octree(octree.depth(), Colour::white, octree.frame()));
  if (plan.is_identity(octree.depth())) return shared(ranks, octree);
  return produced(ranks, detail::ShiftProducer(plan.by, octree, plan.target.depth), plan.target.depth,
                  detail::grown_frame(octree.frame(), plan.target), work);
}

SharedOctree combine(Ranks& ranks, std::span<const Octree> octrees, Operation operation, const Work& work) {
  const int depth = octrees.front().depth();
  const Cuts cuts = cuts_for(ranks, AnyGray(octrees), depth);
  const Stretch mine = stretch_of(cuts, ranks.rank());
  std::vector<Octree> parts;
  for (const Octree& octree : octrees) parts.push_back(part_of(octree, mine));
  Octree result = mine.empty() ? parts.front() : operation(parts, work);
  parts.clear();
  return by_chunks(ranks, result, cuts);
}

}  // namespace blackleaf::mpi
