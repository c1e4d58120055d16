#include "blackleaf/first_contact.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "blackleaf/error.h"
#include "continuous.h"
#include "nearest_pair.h"
#include "octree/parallel.h"
#include "same_depth.h"

namespace blackleaf {
namespace {

using detail::Continuous;
using detail::Stretch;

// Both solids and their paths; a null path is rest.
struct Scene {
  const PreparedSolid &a, &b;
  const Path *path_a, *path_b;

  double begin() const { return path_a == nullptr ? path_b->begin() : std::min(path_a->begin(), path_b->begin()); }
  double end() const { return path_a == nullptr ? path_b->end() : std::max(path_a->end(), path_b->end()); }
  bool is_empty() const { return a.is_empty() || b.is_empty(); }
  double size() const {
    const double side = std::ldexp(1.0, a.depth());
    return detail::coordinate_size(path_a, side) + detail::coordinate_size(path_b, side);
  }
};

std::string in_words(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void check(const Scene& scene, double clearance, double tolerance, const std::string& name) {
  detail::require_same_depth(scene.a, scene.b);
  if (!std::isfinite(clearance)) throw Error(ErrorCode::bad_argument, "the clearance is not finite", "give voxels");
  const double least = scene.size() * 0x1p-38;
  if (!(tolerance >= least) || !std::isfinite(tolerance))
    throw Error(ErrorCode::bad_argument,
                "a " + name + " of " + in_words(tolerance) + " voxels is too small for coordinates of this size",
                "use " + in_words(std::max(least, 1e-6)) + " or more");
}

detail::RigidMap b_from_a(const Stretch& stretch, double s) {
  const detail::RigidMap a = stretch.a.at(s), b = stretch.b.at(s);
  return {a.rotation.transpose() * b.rotation, a.rotation.transpose() * (b.shift - a.shift)};
}

// The nearest points of the solids at a place in a stretch, if they are less than `below` apart; any that are at most
// `enough`.
std::optional<detail::NearestPoints> nearest_at(const Scene& scene, const Stretch& stretch, double s, double below,
                                                double enough) {
  detail::NearestPair pair(detail::boxes(scene.a), detail::boxes(scene.b), b_from_a(stretch, s));
  const auto closed = [](const detail::BoxNode&, const detail::BoxNode&, double distance) { return distance == 0; };
  if (!pair.find(below, enough, closed)) return std::nullopt;
  detail::NearestPoints points = pair.best();
  const detail::RigidMap a = stretch.a.at(s);
  points.on_a = a.rotation * points.on_a + a.shift;
  points.on_b = a.rotation * points.on_b + a.shift;
  return points;
}

struct Hit {
  std::size_t stretch = 0;
  double place = 0, distance = 0;
};

// Looks at stretches of time in order on one thread, at several at once on more; the answer is that of the first one
// with contact (Question::first) or whether there is any.
std::optional<Hit> search(const Scene& scene, const std::vector<Stretch>& stretches, const ContactOptions& options,
                          Continuous::Question question, const Work& work) {
  std::vector<std::optional<Hit>> hits(stretches.size());
  std::atomic<std::size_t> first = stretches.size();
  detail::Progress progress(work, stretches.size() * Continuous::kParts);
  const auto look = [&](std::size_t i) {
    if (i >= first) return;
    Continuous::Settings settings{question, options.clearance, options.tolerance, scene.size(), 0, {}};
    if (work.progress) settings.done = [&](int parts) { progress.step(static_cast<std::size_t>(parts)); };
    Continuous continuous(detail::boxes(scene.a), detail::boxes(scene.b), settings);
    if (!continuous.search(stretches[i])) return;
    hits[i] = Hit{i, continuous.place(), continuous.distance()};
    std::size_t known = first;
    while (i < known && !first.compare_exchange_weak(known, i)) {
    }
  };
  if (stretches.size() == 1 || detail::thread_count(work) == 1) {
    for (std::size_t i = 0; i < stretches.size() && first == stretches.size(); ++i) look(i);
  } else {
    detail::for_each_index(stretches.size(), {work.threads, {}}, look);
  }
  return first == stretches.size() ? std::nullopt : hits[first];
}

std::optional<FirstContact> find_first(const Scene& scene, const ContactOptions& options, const Work& work) {
  check(scene, options.clearance, options.tolerance, "tolerance");
  if (scene.is_empty()) return std::nullopt;
  const std::vector<Stretch> stretches = detail::stretches(scene.path_a, scene.path_b, scene.begin(), scene.end());
  const std::optional<Hit> hit = search(scene, stretches, options, Continuous::Question::first, work);
  if (!hit) return std::nullopt;
  const Stretch& stretch = stretches[hit->stretch];
  FirstContact contact;
  contact.time = stretch.time(hit->place);
  contact.pose_a = scene.path_a == nullptr ? Pose{contact.time, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()}
                                           : scene.path_a->pose_at(contact.time);
  contact.pose_b = scene.path_b->pose_at(contact.time);
  // The leaves that were found bound the distance; others may be nearer yet.
  const double known = std::max(hit->distance, 2 * Continuous::rounding(scene.size()));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  auto nearest = nearest_at(scene, stretch, hit->place, std::nextafter(known, kInfinity), 0);
  if (!nearest) nearest = nearest_at(scene, stretch, hit->place, kInfinity, 0);
  contact.distance = hit->distance < 0 ? hit->distance : nearest->distance;
  contact.on_a = nearest->on_a;
  contact.on_b = nearest->on_b;
  return contact;
}

bool is_clear(const Scene& scene, const ContactOptions& options, const Work& work) {
  check(scene, options.clearance, options.tolerance, "tolerance");
  if (scene.is_empty()) return true;
  const std::vector<Stretch> stretches = detail::stretches(scene.path_a, scene.path_b, scene.begin(), scene.end());
  // A way that is not clear mostly shows it at one of a few places.
  if (options.clearance >= 0) {
    const double below = std::nextafter(options.clearance, std::numeric_limits<double>::infinity());
    const auto met = [&](const Stretch& stretch, double s) {
      return nearest_at(scene, stretch, s, below, options.clearance).has_value();
    };
    if (met(stretches.back(), 1) || met(stretches.front(), 0) || met(stretches[stretches.size() / 2], 0.5))
      return false;
  }
  return !search(scene, stretches, options, Continuous::Question::any, work);
}

std::optional<Clearance> least(const Scene& scene, double from, double to, double precision, const Work& work) {
  check(scene, 0, precision, "precision");
  if (scene.is_empty()) return std::nullopt;
  const std::vector<Stretch> stretches = detail::stretches(scene.path_a, scene.path_b, from, to);
  Clearance result{from, to, 0, std::numeric_limits<double>::infinity(), from};
  const auto offer = [&](const Stretch& stretch, double s) {
    if (const auto points = nearest_at(scene, stretch, s, result.at_most, 0)) {
      result.at_most = points->distance;
      result.time = stretch.time(s);
    }
  };
  offer(stretches.front(), 0);
  for (const Stretch& stretch : stretches) {
    if (stretches.size() <= 16) offer(stretch, 0.5);
    offer(stretch, 1);
  }
  detail::Progress progress(work, stretches.size() * Continuous::kParts);
  for (const Stretch& stretch : stretches) {
    if (result.at_most <= precision) break;
    Continuous::Settings settings{Continuous::Question::least, 0, precision, scene.size(), result.at_most, {}};
    if (work.progress) settings.done = [&](int parts) { progress.step(static_cast<std::size_t>(parts)); };
    Continuous continuous(detail::boxes(scene.a), detail::boxes(scene.b), settings);
    if (continuous.search(stretch)) {
      result.at_most = continuous.distance();
      result.time = stretch.time(continuous.place());
    }
  }
  result.at_least = std::max(0.0, result.at_most - precision);
  return result;
}

}  // namespace

std::optional<FirstContact> first_contact(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                          const ContactOptions& options, const Work& work) {
  return find_first({a, b, nullptr, &path_of_b}, options, work);
}

std::optional<FirstContact> first_contact(const PreparedSolid& a, const Path& path_of_a, const PreparedSolid& b,
                                          const Path& path_of_b, const ContactOptions& options, const Work& work) {
  return find_first({a, b, &path_of_a, &path_of_b}, options, work);
}

bool clear(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b, const ContactOptions& options,
           const Work& work) {
  return is_clear({a, b, nullptr, &path_of_b}, options, work);
}

bool clear(const PreparedSolid& a, const Path& path_of_a, const PreparedSolid& b, const Path& path_of_b,
           const ContactOptions& options, const Work& work) {
  return is_clear({a, b, &path_of_a, &path_of_b}, options, work);
}

std::optional<Clearance> clearance(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                   double precision, const Work& work) {
  return least({a, b, nullptr, &path_of_b}, path_of_b.begin(), path_of_b.end(), precision, work);
}

std::vector<Clearance> clearance_along(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                       const std::vector<double>& times, double precision, const Work& work) {
  if (times.size() < 2)
    throw Error(ErrorCode::bad_argument, "clearance along a path needs two times at least", "give begin and end");
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    if (!(times[i] < times[i + 1]) || !std::isfinite(times[i]) || !std::isfinite(times[i + 1]))
      throw Error(ErrorCode::bad_argument, "times[" + std::to_string(i + 1) + "] is not after the one before",
                  "let times increase");
  const Scene scene{a, b, nullptr, &path_of_b};
  check(scene, 0, precision, "precision");
  if (scene.is_empty()) return {};
  std::vector<Clearance> results(times.size() - 1);
  detail::for_each_index(results.size(), work, [&](std::size_t i) {
    results[i] = *least(scene, times[i], times[i + 1], precision, {1, {}});
  });
  return results;
}

}  // namespace blackleaf
