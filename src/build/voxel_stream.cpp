#include "blackleaf/voxel_stream.h"

#include <algorithm>
#include <cassert>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "block_tree.h"
#include "octree/parallel.h"
#include "octree/produce.h"
#include "pending_rows.h"
#include "volume_placement.h"
#include "volume_scan.h"

namespace blackleaf {
namespace {

using Point = std::array<std::int64_t, 3>;
using detail::BlockTree;

// Enough for the threads to share and for a file to be read at its speed, little enough to stay in the caches.
constexpr std::int64_t kBytesAtOnce = std::int64_t{4} << 20;
// More than four slices of this size are not asked for, though bricks have four.
constexpr std::int64_t kLargeSlice = std::int64_t{64} << 20;
// Values that a thread takes at a time.
constexpr std::int64_t kValuesAtOnce = std::int64_t{1} << 19;

// What has been read of the 64 slices, aligned to the universe's blocks, that are not yet in the tree.
struct Slab {
  Slab(const Point& low, const Point& high) : bricks(low, high) {}

  detail::VolumeBricks bricks;
  std::deque<std::vector<std::uint64_t>> gray;  // a deque, because the bricks know where the vectors are
};

}  // namespace

template <class T>
class VoxelStream<T>::Builder {
 public:
  Builder(const Point& size, const VolumePlacement& placement, Frame frame, Work work)
      : size_(size),
        box_(detail::placed_box(size, placement)),
        frame_(std::move(frame)),
        work_(std::move(work)),
        next_(box_.low[2]) {
    if (box_.depth > BlockTree::kLevel) tree_.emplace(box_.depth, box_.low, box_.high);
  }
  virtual ~Builder() = default;
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  std::int64_t wanted(std::int64_t ahead) const {
    const std::int64_t z = next_ + ahead;
    if (z >= box_.high[2]) return 0;
    const std::int64_t slice = size_[0] * size_[1] * static_cast<std::int64_t>(sizeof(T));  // at most 2^43
    std::int64_t end = z + std::max<std::int64_t>(1, kBytesAtOnce / slice);
    if (slice <= kLargeSlice) end = std::max(end & -4, (z | 3) + 1);
    return std::min({end, slab_end(z), box_.high[2]}) - z;
  }

  void add(const T* slices, std::int64_t count) {
    assert(count >= 0 && next_ + count <= box_.high[2]);
    for (const std::int64_t end = next_ + count; next_ < end;) {
      if (!slab_) begin_slab();
      // Whole bricks go straight into the slab.
      const bool last = end >= std::min(slab_end(next_), box_.high[2]);
      const std::int64_t whole = last ? std::min(slab_end(next_), box_.high[2]) : end & -4;
      const bool at_brick = pending_.empty() && ((next_ & 3) == 0 || next_ == box_.low[2]);
      const std::int64_t taken = at_brick && whole > next_ ? whole - next_ : 1;
      if (at_brick && whole > next_)
        scan(slices, taken);
      else
        keep(slices);
      slices += size_[0] * size_[1] * taken;
      next_ += taken;
      if (next_ == slab_end(next_ - 1) || next_ == box_.high[2]) end_slab();
    }
  }

  Octree finish() {
    assert(next_ == box_.high[2]);
    return tree_ ? tree_->finish(std::move(frame_)) : std::move(*small_);
  }

 protected:
  virtual void scan_strips(const T* slices, std::int64_t count, std::int64_t first, std::int64_t last,
                           std::vector<std::uint64_t>& gray) = 0;
  virtual void keep_slice(const T* slice) = 0;

  static std::int64_t slab_end(std::int64_t z) { return (z | (BlockTree::kSide - 1)) + 1; }

  // The slices [next_, next_ + count) as a part of the whole.
  Work part(std::int64_t count) const {
    const auto done = [&](std::int64_t z) {
      return static_cast<double>(z - box_.low[2]) / static_cast<double>(size_[2]);
    };
    return detail::part_of(work_, done(next_), done(next_ + count));
  }

  // The strips of the bricks that hold the slices [next_, next_ + count).
  std::pair<std::int64_t, std::int64_t> strips(std::int64_t count) const {
    const std::int64_t rows = slab_->bricks.strips() / slab_rows();
    const std::int64_t bottom = slab_->bricks.strip_z(0);
    return {(next_ - bottom) / 4 * rows, ((next_ + count - 1 - bottom) / 4 + 1) * rows};
  }
  // Bricks along z.
  std::int64_t slab_rows() const {
    const auto& bricks = slab_->bricks;
    return (bricks.strip_z(bricks.strips() - 1) - bricks.strip_z(0)) / 4 + 1;
  }

  void begin_slab() {
    Point low = box_.low, high = box_.high;
    low[2] = next_;
    high[2] = std::min(high[2], slab_end(next_));
    slab_.emplace(low, high);
  }

  void scan(const T* slices, std::int64_t count) {
    const auto [first, last] = strips(count);
    const std::int64_t step = std::max<std::int64_t>(1, kValuesAtOnce / (16 * size_[0]));
    const auto parts = static_cast<std::size_t>((last - first + step - 1) / step);
    const std::size_t before = slab_->gray.size();
    slab_->gray.resize(before + parts);
    detail::for_each_index(parts, part(count), [&, first = first, last = last](std::size_t i) {
      const std::int64_t begin = first + static_cast<std::int64_t>(i) * step;
      scan_strips(slices, count, begin, std::min(begin + step, last), slab_->gray[before + i]);
    });
  }

  void keep(const T* slice) {
    keep_slice(slice);
    if ((next_ & 3) == 3 || next_ + 1 == box_.high[2]) {
      const auto [first, last] = strips(1);
      pending_.flush(box_.low, box_.high, first, last, slab_->bricks, slab_->gray.emplace_back());
    }
    detail::Progress(part(1), 1).step();
  }

  void end_slab() {
    const detail::BrickProducer producer(slab_->bricks);
    if (tree_) {
      // The columns of blocks with one y.
      const std::int64_t first = box_.low[1] >> BlockTree::kLevel;
      const std::int64_t count = ((box_.high[1] - 1) >> BlockTree::kLevel) + 1 - first;
      const auto at = [](std::int64_t x) { return static_cast<std::int32_t>(x & -BlockTree::kSide); };
      detail::for_each_index(static_cast<std::size_t>(count), {work_.threads, {}}, [&](std::size_t i) {
        detail::NodeArrays scratch;
        const std::int64_t y = (first + static_cast<std::int64_t>(i)) << BlockTree::kLevel;
        for (std::int64_t x = at(box_.low[0]); x < box_.high[0]; x += BlockTree::kSide)
          tree_->produce(producer, {at(x), at(y), at(next_ - 1), BlockTree::kLevel}, scratch);
      });
    } else {
      small_ = detail::produce(producer, box_.depth, std::move(frame_), {1, {}});
    }
    slab_.reset();
  }

  Point size_;
  detail::PlacedBox box_;
  Frame frame_;
  Work work_;
  std::int64_t next_;  // slice of the universe
  std::optional<Slab> slab_;
  detail::PendingRows pending_;
  std::optional<BlockTree> tree_;  // none for a universe of one block or less:
  std::optional<Octree> small_;
};

template <class T>
template <class Inside>
class VoxelStream<T>::BuilderOf final : public VoxelStream<T>::Builder {
 public:
  BuilderOf(Inside inside, const Point& size, const VolumePlacement& placement, Frame frame, Work work)
      : Builder(size, placement, std::move(frame), std::move(work)), inside_(std::move(inside)) {}

 private:
  void scan_strips(const T* slices, std::int64_t count, std::int64_t first, std::int64_t last,
                   std::vector<std::uint64_t>& gray) override {
    const VolumeView<T> view{slices, {this->size_[0], this->size_[1], count}};
    const Point low = {this->box_.low[0], this->box_.low[1], this->next_};
    detail::VolumeScan<T, Inside>(view, low, inside_, this->slab_->bricks).strips(first, last, gray);
  }
  void keep_slice(const T* slice) override {
    this->pending_.add(slice, this->box_.low, this->box_.high, this->next_, inside_, this->slab_->bricks);
  }

  Inside inside_;
};

template <class T>
VoxelStream<T>::VoxelStream(const std::array<std::int64_t, 3>& size, ValueRange<T> inside, VolumePlacement placement,
                            Frame frame, Work work)
    : builder_(std::make_unique<BuilderOf<detail::InRange<T>>>(detail::InRange<T>{inside.low, inside.high}, size,
                                                               placement, std::move(frame), std::move(work))) {}

template <class T>
VoxelStream<T>::VoxelStream(const std::array<std::int64_t, 3>& size, std::function<bool(T)> inside,
                            VolumePlacement placement, Frame frame, Work work)
    : builder_(std::make_unique<BuilderOf<std::function<bool(T)>>>(std::move(inside), size, placement, std::move(frame),
                                                                   std::move(work))) {}

template <class T>
VoxelStream<T>::~VoxelStream() = default;
template <class T>
VoxelStream<T>::VoxelStream(VoxelStream&&) noexcept = default;
template <class T>
VoxelStream<T>& VoxelStream<T>::operator=(VoxelStream&&) noexcept = default;

template <class T>
std::int64_t VoxelStream<T>::wanted(std::int64_t ahead) const {
  return builder_->wanted(ahead);
}

template <class T>
void VoxelStream<T>::add(const T* slices, std::int64_t count) {
  builder_->add(slices, count);
}

template <class T>
Octree VoxelStream<T>::finish() {
  return builder_->finish();
}

template class VoxelStream<std::uint8_t>;
template class VoxelStream<std::int8_t>;
template class VoxelStream<std::uint16_t>;
template class VoxelStream<std::int16_t>;
template class VoxelStream<std::uint32_t>;
template class VoxelStream<std::int32_t>;
template class VoxelStream<float>;
template class VoxelStream<double>;

}  // namespace blackleaf
