#include "contact_poses.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <numbers>
#include <random>

#include "blackleaf/contact.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

constexpr int kPoses = 200;

Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

// By pose, in order of size.
std::vector<double> seconds_of(int depth, const Ask& ask, int rounds) {
  using Clock = std::chrono::steady_clock;
  const auto& poses = contact_poses(depth);
  std::vector<std::vector<double>> of_poses(poses.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto start = Clock::now();
      benchmark::DoNotOptimize(ask(poses[i]));
      of_poses[i].push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
  std::vector<double> seconds;
  for (auto& of_pose : of_poses) {
    const auto middle = of_pose.begin() + rounds / 2;
    std::nth_element(of_pose.begin(), middle, of_pose.end());
    seconds.push_back(*middle);
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds;
}

}  // namespace

const std::vector<Motion>& contact_poses(int depth) {
  static std::map<int, std::vector<Motion>> made;
  auto& poses = made[depth];
  if (!poses.empty()) return poses;
  std::mt19937 random(1987);
  const PreparedSolid solid(bunny(depth));
  const double side = 1 << depth;
  while (poses.size() < kPoses) {
    const Motion turn =
        Motion::rotation(random_direction(random), std::uniform_real_distribution<double>(0, std::numbers::pi)(random))
            .about(Eigen::Vector3d::Constant(side / 2));
    const Eigen::Vector3d direction = random_direction(random);
    const auto at = [&](double t) { return Motion::translation(t * direction) * turn; };
    double low = 0, high = 2 * side;
    for (int i = 0; i < 14; ++i) {
      const double middle = (low + high) / 2;
      (interferes(solid, solid, at(middle), Meaning::exact) ? low : high) = middle;
    }
    poses.push_back(at(high * std::uniform_real_distribution<double>(0.9, 1.1)(random)));
  }
  return poses;
}

void add_timed_poses(const std::string& key, const std::string& who, int depth, const std::function<Ask()>& prepare,
                     int rounds) {
  for (const double part : {0.5, 0.95})
    contender(key, who + (part == 0.5 ? "" : "_p95"), [=](benchmark::State& state) {
      const Ask ask = prepare();
      for (auto _ : state) {
        const std::vector<double> seconds = seconds_of(depth, ask, rounds);
        state.counters["s"] = seconds[static_cast<std::size_t>(part * static_cast<double>(seconds.size()))];
      }
    })->Iterations(1);
}

}  // namespace blackleaf::bench
