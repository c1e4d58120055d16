// Label maps shifted by whole voxels, turned by quarters and reflected: as octrees are, with labels for colours.
#include "blackleaf/lattice.h"
#include "blackleaf/move.h"
#include "label_tree.h"
#include "lattice_labels.h"
#include "lattice_move.h"
#include "produce_labels.h"
#include "shift_plan.h"

namespace blackleaf {
namespace {

using detail::LabelTree;

// As detail::ShiftProducer: a target node covers at most 2^3 source cells of its level, in the same places at every
// node of that level.
class ShiftedLabels {
 public:
  using Task = std::array<LabelTree::Node, 8>;  // x + 2 y + 4 z

  ShiftedLabels(const LabelMap& map, const std::array<std::int64_t, 3>& by, int depth) : tree_(map, depth), by_(by) {
    for (auto& node : root_) node = LabelTree::Node::of_label(0);
    std::size_t cell = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t low = -by[i] >> depth;
      if (low != 0 && low != -1) return;
      cell |= (low == 0 ? 0u : 1u) << i;
    }
    root_[cell] = tree_.root();
  }

  Task root() const { return root_; }

  std::optional<std::uint32_t> label(const Task& task, int level) const {
    // On an axis on which nodes begin where cells do they cover the lower cell alone.
    const unsigned covered = bits(level, [](std::int64_t start) { return start != 0; });
    for (unsigned i = 0; i < 8; ++i)
      if ((i & ~covered) == 0 && !(task[i] == task[0])) return std::nullopt;
    if (!task[0].has_one_label()) return std::nullopt;
    return task[0].label();
  }

  Task child(const Task& task, int level, unsigned octant) const {
    const unsigned first = bits(level, [&](std::int64_t start) { return (start >> (level - 1)) != 0; });
    Task result;
    for (unsigned i = 0; i < 8; ++i) {
      unsigned cell = 0, in_cell = 0;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned place = (first >> axis & 1) + (octant >> axis & 1) + (i >> axis & 1);
        cell |= place >> 1 << axis;
        in_cell |= (place & 1) << axis;
      }
      result[i] = tree_.child(task[cell], in_cell);
    }
    return result;
  }

 private:
  // By axis: what holds of the place in a cell of this level at which nodes of this level begin.
  template <class Holds>
  unsigned bits(int level, const Holds& holds) const {
    unsigned result = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      result |= (holds(-by_[axis] & ((std::int64_t{1} << level) - 1)) ? 1u : 0u) << axis;
    return result;
  }

  LabelTree tree_;
  std::array<std::int64_t, 3> by_;
  Task root_;
};

class TransformedLabels {
 public:
  using Task = LabelTree::Node;

  TransformedLabels(const LabelMap& map, const LatticeSymmetry& symmetry)
      : tree_(map, map.depth()), labels_(symmetry) {}

  Task root() const { return tree_.root(); }
  std::optional<std::uint32_t> label(const Task& task, int) const {
    if (!task.has_one_label()) return std::nullopt;
    return task.label();
  }
  Task child(const Task& task, int, unsigned octant) const { return tree_.child(task, labels_.source(octant)); }

 private:
  LabelTree tree_;
  detail::LatticeLabels labels_;
};

}  // namespace

LabelMap translate(const LabelMap& map, const std::array<std::int64_t, 3>& by, Leaving leaving, const Work& work) {
  const auto box = bounding_box(octree_from_labels(map));
  if (!box) return map;
  const detail::ShiftPlan plan = detail::plan_shift(map.depth(), *box, by, leaving);
  if (plan.gone) return LabelMap(map.depth(), map.frame());
  if (plan.is_identity(map.depth())) return map;
  return detail::produce_labels(ShiftedLabels(map, plan.by, plan.target.depth), plan.target.depth,
                                detail::grown_frame(map.frame(), plan.target), work);
}

LabelMap transform(const LabelMap& map, const LatticeSymmetry& symmetry, const Work& work) {
  if (symmetry == LatticeSymmetry()) return map;
  return detail::produce_labels(TransformedLabels(map, symmetry), map.depth(), map.frame(), work);
}

LabelMap transform(const LabelMap& map, const LatticeSymmetry& symmetry, const Eigen::Vector3d& about, Leaving leaving,
                   const Work& work) {
  const auto by = detail::shift_after(symmetry, about, map.depth());
  return translate(transform(map, symmetry, detail::part_of(work, 0, 0.5)), by, leaving, detail::part_of(work, 0.5, 1));
}

}  // namespace blackleaf
