#include "file/solid_coder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "file/damage.h"
#include "file/solid_walk.h"
#include "octree/parallel.h"

namespace blackleaf::detail {
namespace {

using solid::Walk;

// The bytes of a brick are coded in this order: each is followed by one that does not depend on it where that can be,
// so that a processor can work on both.
using BrickOrder = std::integer_sequence<unsigned, 0, 1, 2, 4, 3, 5, 6, 7>;

// Codes the bricks at which the walks stand, byte by byte in turns.
template <class Coder, std::size_t... kLane, unsigned... kOctant>
[[gnu::always_inline]] inline void code_bricks(const std::array<Walk<Coder>*, sizeof...(kLane)>& walks,
                                               std::index_sequence<kLane...> /*lanes*/,
                                               std::integer_sequence<unsigned, kOctant...> /*order*/) {
  const CornerModel& corners = CornerModel::get();
  typename Walk<Coder>::Brick bricks[] = {typename Walk<Coder>::Brick(*walks[kLane])...};
  const auto add = [&]<unsigned kAt>(std::integral_constant<unsigned, kAt> /*octant*/) __attribute__((always_inline)) {
    (bricks[kLane].template add_byte<kAt>(corners), ...);
  };
  (add(std::integral_constant<unsigned, kOctant>()), ...);
  (bricks[kLane].finish(), ...);
}

template <class Coder, std::size_t kCount>
[[gnu::noinline]] void code_bricks(const std::array<Walk<Coder>*, kCount>& walks) {
  for (Walk<Coder>* walk : walks) walk->make_room();
  code_bricks<Coder>(walks, std::make_index_sequence<kCount>(), BrickOrder());
}

// Reads chunks, two at a time on each thread. A reader cannot know where to look next before it has the last voxels:
// most of its time is waiting, and while one chunk waits another can go on. Three at a time are no faster.
class PartsReader {
 public:
  PartsReader(std::span<SolidPart> parts, int level, const ChunkContents& contents)
      : parts_(parts), level_(level), contents_(contents) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].coded) order_.push_back(i);
    // The largest first, so that all threads end at much the same time.
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return parts[a].bytes > parts[b].bytes; });
  }

  void read_all(const Work& work) {
    progress_.emplace(work, order_.size());
    const std::size_t threads = std::min(static_cast<std::size_t>(thread_count(work)), order_.size());
    for_each_index(threads, Work{static_cast<int>(threads), {}}, [&](std::size_t /*thread*/) { read(); });
  }

 private:
  struct Lane {
    std::vector<std::uint8_t> bytes;
    Walk<NibbleDecoder> walk;
    SolidPart* part = nullptr;
  };

  // What each thread does until no chunk is left.
  void read() {
    std::array<Lane, 2> lanes;
    Lane *first = &lanes[0], *second = &lanes[1];
    bool one = begin(*first);
    bool two = begin(*second);
    while (one && two) {
      code_bricks<NibbleDecoder, 2>({&first->walk, &second->walk});
      one = go_on(*first);
      two = go_on(*second);
    }
    for (Lane& lane = one ? *first : *second; one || two; one = two = go_on(lane))
      code_bricks<NibbleDecoder, 1>({&lane.walk});
  }

  // Takes the next chunk that has bricks. False if there is none.
  bool begin(Lane& lane) {
    for (std::size_t next; (next = taken_++) < order_.size();) {
      lane.part = &parts_[order_[next]];
      const bool bricks = more(lane, [&] {
        lane.bytes = contents_(order_[next]);
        const std::size_t size = lane.bytes.size();
        lane.bytes.resize(size + NibbleDecoder::kPadding);
        return lane.walk.start(NibbleDecoder({lane.bytes.data(), size}), level_, Node());
      });
      if (bricks) return true;
    }
    return false;
  }

  // Goes on to the next brick, of the next chunk if need be. False if there is none.
  bool go_on(Lane& lane) {
    return more(lane, [&] { return lane.walk.go_on(); }) || begin(lane);
  }

  // Whether step() finds another brick in the lane's chunk; if not, the chunk is done.
  template <class Step>
  bool more(Lane& lane, const Step& step) {
    try {
      if (step()) return true;
      lane.walk.coder().expect_end();
      lane.part->top = lane.walk.gather(lane.part->table, lane.part->arrays);
    } catch (const Damage& damage) {
      lane.part->damage = damage.what;
    }
    progress_->step();
    return false;
  }

  const std::span<SolidPart> parts_;
  const int level_;
  const ChunkContents& contents_;
  std::vector<std::size_t> order_;  // of the chunks that have contents
  std::atomic<std::size_t> taken_ = 0;
  std::optional<Progress> progress_;
};

}  // namespace

std::vector<std::uint8_t> encode_solid(const Node& node) {
  Walk<NibbleEncoder> walk;
  for (bool more = walk.start(NibbleEncoder(), node.level(), node); more; more = walk.go_on())
    code_bricks<NibbleEncoder, 1>({&walk});
  return walk.coder().finish();
}

void decode_solids(std::span<SolidPart> parts, int level, const Work& work, const ChunkContents& contents) {
  PartsReader(parts, level, contents).read_all(work);
}

}  // namespace blackleaf::detail
