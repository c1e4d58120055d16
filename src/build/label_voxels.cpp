#include "blackleaf/label_voxels.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <charconv>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "blackleaf/error.h"
#include "label_blocks.h"
#include "label_rules.h"
#include "octree/parallel.h"
#include "volume_placement.h"

namespace blackleaf {
namespace detail {

// Cuts the stream of slices into layers of four and hands them on, as many of one slab at once as there are.
template <class T>
class LabelEngine {
 public:
  LabelEngine(const std::array<std::int64_t, 3>& size, const VolumePlacement& placement, Frame frame, Work work)
      : size_(size),
        box_(placed_box(size, placement)),
        frame_(std::move(frame)),
        work_(std::move(work)),
        next_(box_.low[2]) {}
  virtual ~LabelEngine() = default;
  LabelEngine(const LabelEngine&) = delete;
  LabelEngine& operator=(const LabelEngine&) = delete;

  void add(const T* slices, std::int64_t count) {
    const std::int64_t slice = size_[0] * size_[1];
    while (count > 0) {
      const std::int64_t z = next_ + held_, layer_end = std::min((z | 3) + 1, box_.high[2]);
      assert(z < box_.high[2]);
      std::int64_t taken = 0;
      if (held_ > 0 || z + count < layer_end) {
        taken = std::min(count, layer_end - z);
        held_slices_.resize(static_cast<std::size_t>(4 * slice));
        std::copy_n(slices, taken * slice, held_slices_.begin() + held_ * slice);
        held_ += taken;
        if (z + taken == layer_end) {
          held_ = 0;
          layers(held_slices_.data(), layer_end);
        }
      } else {
        const std::int64_t slab_end = std::min((z | 63) + 1, box_.high[2]);
        const std::int64_t end = z + count >= slab_end ? slab_end : (z + count) & ~std::int64_t{3};
        taken = end - z;
        layers(slices, end);
      }
      slices += taken * slice;
      count -= taken;
    }
  }

  LabelMap finish() {
    assert(next_ == box_.high[2]);
    return join(std::move(frame_));
  }

 protected:
  // Slices [z0, z1) of the universe: whole layers of one slab, as far as the volume has them.
  virtual void scan(const T* slices, std::int64_t z0, std::int64_t z1, const Work& work) = 0;
  virtual void close_slab(const Work& work) = 0;
  virtual LabelMap join(Frame frame) = 0;

  // The volume in the universe, [low, high).
  const std::array<std::int64_t, 3>& low() const { return box_.low; }
  const std::array<std::int64_t, 3>& high() const { return box_.high; }
  const std::array<std::int64_t, 3>& size() const { return size_; }
  int depth() const { return box_.depth; }

 private:
  void layers(const T* slices, std::int64_t end) {
    const auto fraction = [&](double z) {
      return (z - static_cast<double>(box_.low[2])) / static_cast<double>(size_[2]);
    };
    // Walking through a slab takes about as long as reading sixteen of its slices.
    constexpr double kWalk = 16;
    const bool closes = (end & 63) == 0 || end == box_.high[2];
    const double begin = fraction(static_cast<double>(next_)), done = fraction(static_cast<double>(end));
    const double read = closes ? std::max(begin, fraction(static_cast<double>(end) - kWalk)) : done;
    scan(slices, next_, end, part_of(work_, begin, read));
    next_ = end;
    if (closes) close_slab(part_of(work_, read, done));
  }

  const std::array<std::int64_t, 3> size_;
  const PlacedBox box_;
  Frame frame_;
  const Work work_;
  std::int64_t next_;           // z of the first slice that is not in the blocks
  std::vector<T> held_slices_;  // those that do not yet fill a layer
  std::int64_t held_ = 0;
};

namespace {

// A number as it was written, as far as doubles go.
template <class T>
std::string text(T value) {
  std::array<char, 64> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

template <class T, class Rule>
class RuledEngine final : public LabelEngine<T> {
  using Label = typename Rule::Label;
  using Blocks = LabelBlocks<Label>;

 public:
  RuledEngine(Rule rule, const std::array<std::int64_t, 3>& size, const VolumePlacement& placement, Frame frame,
              Work work)
      : LabelEngine<T>(size, placement, std::move(frame), std::move(work)), rule_(std::move(rule)) {}

 private:
  static constexpr std::int64_t kValuesAtOnce = std::int64_t{1} << 17;  // of a thread, between two reports of progress

  void scan(const T* slices, std::int64_t z0, std::int64_t z1, const Work& work) override {
    // Only now: a header can promise more than there is.
    if (!blocks_) blocks_.emplace(this->depth(), this->low(), this->high());
    const std::int64_t step = std::max<std::int64_t>(1, kValuesAtOnce / (16 * this->size()[0]));
    const std::int64_t strips = blocks_->last_strip() - blocks_->first_strip(), parts = (strips + step - 1) / step;
    const std::int64_t first_layer = z0 >> 2, layers = ((z1 + 3) >> 2) - first_layer;
    std::atomic<bool> good = true;
    for_each_index(static_cast<std::size_t>(parts * layers), work, [&](std::size_t index) {
      const auto i = static_cast<std::int64_t>(index);
      const std::int64_t layer = first_layer + i / parts, begin = blocks_->first_strip() + i % parts * step;
      std::vector<Label> labels(Rule::kSame ? 0 : static_cast<std::size_t>(16 * this->size()[0]));
      for (std::int64_t strip = begin; strip < std::min(begin + step, blocks_->last_strip()); ++strip)
        if (!take(slices, z0, strip, layer, labels)) good = false;
    });
    if (!good) refuse(slices, z0, z1);
  }

  // One strip of the slices that begin at z0; false if a value is no label.
  bool take(const T* slices, std::int64_t z0, std::int64_t strip, std::int64_t layer, std::vector<Label>& labels) {
    const auto& [low, high, size] = std::tie(this->low(), this->high(), this->size());
    typename Blocks::Rows rows{};
    bool good = true;
    for (std::size_t row = 0; row < 16; ++row) {
      const std::int64_t y = 4 * strip + static_cast<std::int64_t>(row & 3);
      const std::int64_t z = 4 * layer + static_cast<std::int64_t>(row >> 2);
      if (y < low[1] || y >= high[1] || z < low[2] || z >= high[2]) continue;
      const T* const values = slices + size[0] * (y - low[1] + size[1] * (z - z0));
      if constexpr (Rule::kSame) {
        rows[row] = values;
      } else {
        Label* const place = labels.data() + static_cast<std::int64_t>(row) * size[0];
        good &= rule_(values, size[0], place);
        rows[row] = place;
      }
    }
    blocks_->set(strip, layer, rows);
    return good;
  }

  [[noreturn]] void refuse(const T* slices, std::int64_t z0, std::int64_t z1) const {
    const std::int64_t count = (z1 - z0) * this->size()[0] * this->size()[1];
    std::int64_t i = 0;
    for (Label label; i + 1 < count && rule_(slices + i, 1, &label);) ++i;
    const std::int64_t row = i / this->size()[0];
    throw Error(ErrorCode::bad_input,
                "the value " + text(slices[i]) + " of voxel (" + std::to_string(i % this->size()[0]) + ", " +
                    std::to_string(row % this->size()[1]) + ", " +
                    std::to_string(z0 - this->low()[2] + row / this->size()[1]) +
                    ") is no label, which is a whole number from 0 to 4294967295",
                "make labels of ranges of values with bands (--bands)");
  }

  void close_slab(const Work& work) override { blocks_->close_slab(work); }
  LabelMap join(Frame frame) override { return blocks_->join(std::move(frame)); }

  const Rule rule_;
  std::optional<Blocks> blocks_;
};

void check(const Bands& bands) {
  const std::vector<double>& t = bands.thresholds;
  const auto fail = [](const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::bad_argument, what, remedy);
  };
  if (t.empty()) fail("there are no thresholds between the bands", "give at least one");
  if (t.size() > 0xFFFF) fail(std::to_string(t.size()) + " thresholds are too many", "give at most 65535");
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(t[i])) fail("the threshold " + text(t[i]) + " is not finite", "give numbers");
    if (i > 0 && t[i] <= t[i - 1])
      fail("the thresholds do not increase: " + text(t[i]) + " comes after " + text(t[i - 1]), "sort them");
  }
}

template <class T>
std::unique_ptr<LabelEngine<T>> engine_for(Labelling<T> labelling, const std::array<std::int64_t, 3>& size,
                                           const VolumePlacement& placement, Frame frame, Work work) {
  const auto make = [&](auto rule) -> std::unique_ptr<LabelEngine<T>> {
    return std::make_unique<RuledEngine<T, decltype(rule)>>(std::move(rule), size, placement, std::move(frame),
                                                            std::move(work));
  };
  if (const auto* const bands = std::get_if<Bands>(&labelling)) {
    check(*bands);
    if (bands->thresholds.size() <= 0xFF) return make(BandRule<T, std::uint8_t>(bands->thresholds));
    return make(BandRule<T, std::uint16_t>(bands->thresholds));
  }
  if (auto* const label_of = std::get_if<LabelOf<T>>(&labelling)) {
    assert(*label_of);
    return make(FunctionRule<T>(std::move(*label_of)));
  }
  return make(WholeNumberRule<T>());
}

}  // namespace
}  // namespace detail

template <class T>
LabelVolumeBuilder<T>::LabelVolumeBuilder(const std::array<std::int64_t, 3>& size, Labelling<T> labelling,
                                          VolumePlacement placement, Frame frame, Work work)
    : engine_(detail::engine_for<T>(std::move(labelling), size, placement, std::move(frame), std::move(work))) {}
template <class T>
LabelVolumeBuilder<T>::~LabelVolumeBuilder() = default;
template <class T>
LabelVolumeBuilder<T>::LabelVolumeBuilder(LabelVolumeBuilder&&) noexcept = default;
template <class T>
LabelVolumeBuilder<T>& LabelVolumeBuilder<T>::operator=(LabelVolumeBuilder&&) noexcept = default;

template <class T>
void LabelVolumeBuilder<T>::add(const T* slices, std::int64_t count) {
  engine_->add(slices, count);
}

template <class T>
LabelMap LabelVolumeBuilder<T>::finish() {
  return std::exchange(engine_, nullptr)->finish();
}

template <class T>
LabelMap label_map_from_voxels(const VolumeView<T>& volume, const Labelling<T>& labelling, VolumePlacement placement,
                               Frame frame, const Work& work) {
  LabelVolumeBuilder<T> builder(volume.size, labelling, placement, std::move(frame), work);
  builder.add(volume.data, volume.size[2]);
  return builder.finish();
}

#define BLACKLEAF_INSTANTIATE(T)                                                                                \
  template class LabelVolumeBuilder<T>;                                                                         \
  template LabelMap label_map_from_voxels<T>(const VolumeView<T>&, const Labelling<T>&, VolumePlacement, Frame, \
                                             const Work&);
BLACKLEAF_INSTANTIATE(std::uint8_t)
BLACKLEAF_INSTANTIATE(std::int8_t)
BLACKLEAF_INSTANTIATE(std::uint16_t)
BLACKLEAF_INSTANTIATE(std::int16_t)
BLACKLEAF_INSTANTIATE(std::uint32_t)
BLACKLEAF_INSTANTIATE(std::int32_t)
BLACKLEAF_INSTANTIATE(std::uint64_t)
BLACKLEAF_INSTANTIATE(std::int64_t)
BLACKLEAF_INSTANTIATE(float)
BLACKLEAF_INSTANTIATE(double)
#undef BLACKLEAF_INSTANTIATE

}  // namespace blackleaf
