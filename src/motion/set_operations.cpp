#include "blackleaf/set_operations.h"

#include "octree/produce.h"
#include "octree/same_depth.h"

namespace blackleaf {
namespace {

// An operation on the colours of a and b, one bit a voxel.
struct And {
  static std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a & b; }
};
struct Or {
  static std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a | b; }
};
struct Minus {
  static std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a & ~b; }
};
struct Xor {
  static std::uint64_t bits(std::uint64_t a, std::uint64_t b) { return a ^ b; }
};

Colour colour_of(std::uint64_t bits) { return bits ? Colour::black : Colour::white; }
std::uint64_t all(const Node& n) { return n.is_black() ? ~std::uint64_t{0} : 0; }

template <class Operation>
struct PairProducer {
  struct Task {
    Node a, b;
  };
  Task top;

  Task root() const { return top; }
  Colour classify(Task& task, const Cube&) const {
    const bool a = !task.a.is_gray(), b = !task.b.is_gray();
    if (a && b) return colour_of(Operation::bits(all(task.a), all(task.b)));
    // One side alone decides when both colours of the other give the same.
    if (a && Operation::bits(all(task.a), 0) == Operation::bits(all(task.a), ~std::uint64_t{0}))
      return colour_of(Operation::bits(all(task.a), 0));
    if (b && Operation::bits(0, all(task.b)) == Operation::bits(~std::uint64_t{0}, all(task.b)))
      return colour_of(Operation::bits(0, all(task.b)));
    return Colour::gray;
  }
  Task child(const Task& task, const Cube&, int octant) const { return {task.a.child(octant), task.b.child(octant)}; }
  std::uint64_t brick(const Task& task, const Cube&) const { return Operation::bits(task.a.brick(), task.b.brick()); }
};

template <class Operation>
Octree combine(const Octree& a, const Octree& b, const Work& work) {
  detail::require_same_depth(a, b);
  return detail::produce(PairProducer<Operation>{{detail::brick_level_root(a), detail::brick_level_root(b)}}, a.depth(),
                         a.frame(), work);
}

}  // namespace

Octree unite(const Octree& a, const Octree& b, const Work& work) { return combine<Or>(a, b, work); }
Octree intersect(const Octree& a, const Octree& b, const Work& work) { return combine<And>(a, b, work); }
Octree subtract(const Octree& a, const Octree& b, const Work& work) { return combine<Minus>(a, b, work); }
Octree symmetric_difference(const Octree& a, const Octree& b, const Work& work) { return combine<Xor>(a, b, work); }
Octree complement(const Octree& a, const Work& work) {
  return combine<Minus>(Octree(a.depth(), Colour::black, a.frame()), a, work);
}

}  // namespace blackleaf
