// curve/decode, curve/encode: node number to voxel and back on the curve of order 10 (decode20, encode20: of order 20),
// random numbers one at a time. curve/walk: a voxel of a walk in order.
#include "blackleaf/curve.h"

#include <algorithm>
#include <random>

#include "contenders.h"
#include "inputs.h"
#include "papers/mhf92.h"

namespace blackleaf::bench {
namespace {

constexpr int kWalkOrder = 10;
constexpr std::uint64_t kWalk = std::uint64_t{1} << 20;
constexpr std::size_t kNumbers = 4096;

std::vector<std::uint64_t> random_numbers(int order) {
  std::mt19937_64 random(1992);
  std::vector<std::uint64_t> numbers(kNumbers);
  for (auto& number : numbers) number = random() >> (64 - 3 * order);
  return numbers;
}

// Times work(item) for each item in turn.
template <class Items, class Function>
void each(benchmark::State& state, const Items& items, const Function& work) {
  for (auto _ : state)
    for (const auto& item : items) benchmark::DoNotOptimize(work(item));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(items.size()));
}

}  // namespace

void add_curve() {
  namespace mhf92 = papers::mhf92;
  for (const int order : {10, 20}) {
    const std::string suffix = order == 10 ? "" : std::to_string(order);
    contender("curve/decode" + suffix, "ours", [=](benchmark::State& state) {
      each(state, random_numbers(order), [=](std::uint64_t number) { return curve::voxel(order, number); });
    });
    contender("curve/decode" + suffix, "paper", [=](benchmark::State& state) {
      each(state, random_numbers(order), [=](std::uint64_t number) { return mhf92::node_no_to_xyz(order, number); });
    });
    contender("curve/encode" + suffix, "ours", [=](benchmark::State& state) {
      std::vector<curve::Voxel> voxels;
      for (const std::uint64_t number : random_numbers(order)) voxels.push_back(curve::voxel(order, number));
      each(state, voxels, [=](const curve::Voxel& voxel) { return curve::number(order, voxel); });
    });
    contender("curve/encode" + suffix, "paper", [=](benchmark::State& state) {
      std::vector<mhf92::Coordinates> voxels;
      for (const std::uint64_t number : random_numbers(order)) voxels.push_back(mhf92::node_no_to_xyz(order, number));
      each(state, voxels, [=](const mhf92::Coordinates& voxel) { return mhf92::xyz_to_node_no(order, voxel); });
    });
  }
  contender("curve/walk", "ours", [](benchmark::State& state) {
    for (auto _ : state)
      curve::walk(kWalkOrder, 0, kWalk, [](const curve::Voxel& voxel) { benchmark::DoNotOptimize(voxel); });
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kWalk));
  });
  // Section 4's walkround without its database.
  contender("curve/walk", "paper", [](benchmark::State& state) {
    for (auto _ : state)
      for (std::uint64_t number = 0; number < kWalk; ++number)
        benchmark::DoNotOptimize(mhf92::node_no_to_xyz(kWalkOrder, number));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kWalk));
  });
}

}  // namespace blackleaf::bench
