// Continuous: two solids over a stretch of time, proven apart or brought to contact.
//
// An interval of time carries a list of pairs of nodes that are not yet known to stay apart in it. What settles a pair:
//
// 1. Chords. A point that turns by an angle p within the interval is never farther than (p^2 / 8) r from where it would
//    be if it went evenly along its chord, r its distance from the axis: |f''| <= p^2 r in a unit of time. With
//    translations, which are straight, that is the relative motion of two points of the solids up to `slack`, the sum
//    for both solids.
// 2. Balls. The chord of the relative motion of the centres passes the origin at more than both radii + slack + c.
// 3. Axes. For a direction n fixed in space the gap of the projections is at least its lesser value at both ends of the
//    interval, less the slack of the boxes' points: each pair of points is on one side of that at both ends, and goes
//    evenly between them. n is the best of the 15 axes at the interval's middle, or the shortest connection there.
//
// So a pair that slides along a wall, however near and fast, is settled at once, because nothing moves across the wall;
// and slacks fall with the square of the interval. A pair that is not settled is split into those of its children while
// it is larger than what it moves in the interval, and otherwise waits for both halves of the interval. When two leaves
// move at most `tolerance` in an interval, their distance at its beginning decides.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "box_tree.h"
#include "stretch.h"

namespace blackleaf::detail {

class Continuous {
 public:
  enum class Question {
    first,  // the first time at which the distance is no more than clearance + tolerance
    any,    // any such time
    least,  // the least distance, up to tolerance
  };
  struct Settings {
    Question question = Question::first;
    double clearance = 0, tolerance = 0;
    double size = 0;                // of coordinates
    double above = 0;               // least: a distance on the way that is known already
    std::function<void(int)> done;  // told of parts of the stretch that are finished, kParts in all; may be empty
  };
  static constexpr int kPartBits = 5, kParts = 1 << kPartBits;

  /// Requires: neither tree is empty.
  Continuous(const BoxTree& a, const BoxTree& b, const Settings& settings) : a_(a), b_(b), settings_(settings) {
    slop_ = rounding(settings.size);
    above_ = settings.above;
  }

  /// What a position is off by: each comes from less than 2^7 operations of doubles of at most `size`, in errors of
  /// 2^-53 of it.
  static double rounding(double size) { return size * 0x1p-44; }

  /// True iff there is contact in the stretch (first, any), or a distance below the least one known so far (least).
  bool search(const Stretch& stretch);
  /// Where in the stretch, from 0 to 1, after search() has said true.
  double place() const { return place_; }
  /// The distance of two leaves then (negative: how deep they are in each other); the least distance known.
  double distance() const { return least() ? above_ : distance_; }

 private:
  struct Pair {
    std::uint32_t a, b;
  };
  struct Moment {
    RigidMap a, b;
  };
  struct View;
  enum class Verdict { apart, split_a, split_b, wait, contact };

  bool least() const { return settings_.question == Question::least; }
  double clearance() const { return least() ? above_ - settings_.tolerance : settings_.clearance; }
  Moment at(double s) const { return {stretch_->a.at(s), stretch_->b.at(s)}; }
  bool interval(double begin, double end, const Moment& at_begin, const Moment& at_end, std::size_t first, int depth);
  Verdict judge(const Pair& pair, const View& view);
  Verdict judge_at_begin(const Pair& pair, const View& view);
  Verdict contact(double place, double distance);
  /// A lesser distance is known. True iff no lesser one matters.
  bool lower(double place, double distance);

  const BoxTree &a_, &b_;
  Settings settings_;
  const Stretch* stretch_ = nullptr;
  std::vector<Pair> pairs_, stack_;
  double slop_ = 0, above_ = 0, place_ = 0, distance_ = 0;
  bool lowered_ = false;
};

}  // namespace blackleaf::detail
