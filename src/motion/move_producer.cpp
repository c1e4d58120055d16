#include "move_producer.h"

namespace blackleaf::detail {
namespace {

constexpr int kBits = MovedBack::kBits;
constexpr int kCut = kBits - kCentreBits;

std::uint16_t cut(std::int64_t coordinate) { return static_cast<std::uint16_t>(coordinate >> kCut); }

}  // namespace

MoveProducer::MoveProducer(const FixedMotion& motion, const Octree& source, int depth)
    : back_(motion), source_(source), depth_(depth) {
  for (std::size_t bit = 0; bit < 64; ++bit)
    for (std::size_t axis = 0; axis < 3; ++axis)
      (bit % 2 == 0 ? cut_steps_.even : cut_steps_.odd)[axis][bit / 2] = cut(back_.steps()[bit][axis]);
  for (std::size_t octant = 0; octant < 8; ++octant)
    octants_[octant] = back_.step(octant & 1 ? 4 : 0, octant & 2 ? 4 : 0, octant & 4 ? 4 : 0);
  // One unit is added so that what is cut off cannot matter (centre_kernel.h). Where all centres lie on lattice planes
  // across an axis, half a voxel on each side is looked up instead, and either may be black: the solid is closed.
  planes_side_ = {{1, 1, 1}};
  constexpr std::uint16_t kHalf = 1u << (kCentreBits - 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!back_.always_on_planes(axis)) continue;
    const std::size_t sides = planes_side_.size();
    for (std::size_t i = 0; i < sides; ++i) {
      planes_side_[i][axis] = kHalf;
      planes_side_.push_back(planes_side_[i]);
      planes_side_.back()[axis] = static_cast<std::uint16_t>(-kHalf);
    }
  }
}

MoveProducer::Task MoveProducer::root() const {
  Task task;
  enter(task, {0, 0, 0, depth_ < 3 ? 3 : depth_});
  return task;
}

MoveProducer::Task MoveProducer::child(const Task& task, const Cube& cube, int) const {
  Task below;
  if (task.above_source) {
    enter(below, cube);
  } else {
    const MovedBack::Box box = back_.box(cube);
    const CellRange cells = box.cells(cube.level);
    below.colour = task.source.colour(cells);
    if (below.colour == Colour::gray) {
      below.source.narrow(source_, task.source, cells);
      below.colour = below.source.colour(box.cells(cube.level - 1));
    }
  }
  return below;
}

void MoveProducer::enter(Task& task, const Cube& cube) const {
  const MovedBack::Box box = back_.box(cube);
  const CellRange cells = box.cells(cube.level);
  task.above_source = cube.level > source_.level();
  if (task.above_source) {
    task.colour = Colour::gray;  // at this level the whole source is in cell (0,0,0)
    for (std::size_t i = 0; i < 3; ++i)
      if (cells.low[i] > 0 || cells.high[i] < 0) task.colour = Colour::white;
  } else {
    task.source.enter(source_, cells);
    task.colour = task.source.colour(box.cells(cube.level - 1));
  }
}

std::array<Subtree, 8> MoveProducer::bricks(const Task& task, const Cube& cube) const {
  std::array<Subtree, 8> children;
  if (task.colour != Colour::gray) {
    children.fill(Subtree::uniform(task.colour));
    return children;
  }
  const Neighbourhood& source = task.source;
  const MovedBack::Point corner = back_.centre(cube.x, cube.y, cube.z);
  std::array<BrickLookUp, 8> look_ups;
  std::array<MovedBack::Point, 8> firsts;
  std::array<std::uint8_t, 8> octants{};
  std::size_t count = 0;
  for (std::size_t octant = 0; octant < 8; ++octant) {
    const MovedBack::Point first = MovedBack::sum(corner, octants_[octant]);
    const MovedBack::Box box = back_.brick_box(first);
    const Colour colour = source.colour(box.cells(2));
    children[octant] = Subtree::uniform(colour);
    if (colour != Colour::gray) continue;
    const CellRange cells = box.cells(3);
    BrickLookUp& look_up = look_ups[count];
    look_up.cell = static_cast<std::uint8_t>(source.index(cells.low[0], cells.low[1], cells.low[2]));
    for (std::size_t axis = 0, width = 1; axis < 3; ++axis, width *= Neighbourhood::kWidth) {
      look_up.next[axis] =
          static_cast<std::uint8_t>((cells.high[axis] - cells.low[axis]) * static_cast<std::int64_t>(width));
      look_up.pair[axis] = static_cast<std::uint8_t>(box.low[axis] >> (kBits + 1) & 3);
    }
    firsts[count] = first;
    octants[count++] = static_cast<std::uint8_t>(octant);
  }
  std::array<std::uint64_t, 8> bits{};
  for (const auto& side : planes_side_) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        look_ups[i].first[axis] = static_cast<std::uint16_t>(cut(firsts[i][axis]) + side[axis]);
    detail::look_up(cut_steps_, source, {look_ups.data(), count});
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t unclear = look_ups[i].unclear;
      bits[i] |= look_ups[i].bits & ~unclear;
      if (unclear != 0) bits[i] |= exactly(firsts[i], look_ups[i], unclear);
    }
  }
  for (std::size_t i = 0; i < count; ++i) children[octants[i]] = Subtree::brick(bits[i]);
  return children;
}

std::uint64_t MoveProducer::brick(const Task& task, const Cube&) const {
  const Subtree first = bricks(task, {0, 0, 0, 3})[0];
  return first.colour == Colour::gray ? first.word : first.colour == Colour::black ? ~std::uint64_t{0} : 0;
}

void MoveProducer::reserve(NodeArrays& arrays) const {
  for (int level = 2; level < depth_; ++level) {
    const std::size_t count = source_.count(level);
    arrays.reserve(level, count + count / 8);
  }
}

// The colours of the closed solid at some centres of a brick.
std::uint64_t MoveProducer::exactly(const MovedBack::Point& first, const BrickLookUp& found,
                                    std::uint64_t which) const {
  constexpr std::int64_t kFraction = (std::int64_t{1} << kBits) - 1;
  const auto black = [&](const MovedBack::Point& q) {
    const std::int64_t x = q[0] >> kBits, y = q[1] >> kBits, z = q[2] >> kBits;
    // Exactly on a lattice plane: the closed cubes on both sides hold the point.
    const int on_x = (q[0] & kFraction) == 0, on_y = (q[1] & kFraction) == 0, on_z = (q[2] & kFraction) == 0;
    for (int i = 0; i <= on_x; ++i)
      for (int j = 0; j <= on_y; ++j)
        for (int k = 0; k <= on_z; ++k)
          if (found.black(x - i, y - j, z - k)) return true;
    return false;
  };
  std::uint64_t bits = 0;
  for (std::uint64_t rest = which; rest != 0; rest &= rest - 1) {
    const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
    bits |= std::uint64_t{black(MovedBack::sum(first, back_.steps()[bit]))} << bit;
  }
  return bits;
}

}  // namespace blackleaf::detail
