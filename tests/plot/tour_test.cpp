#include "plot/tour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "plot/end_tree.h"

namespace blackleaf::detail {
namespace {

std::vector<Ends> random_chains(std::mt19937_64& random, std::size_t count, bool lattice) {
  std::uniform_real_distribution<double> place(0, 100);
  const auto point = [&]() -> Eigen::Vector2d {
    if (lattice) return {double(random() % 5), double(random() % 5)};
    const double x = place(random);
    return {x, place(random)};
  };
  std::vector<Ends> chains(count);
  for (Ends& chain : chains) chain = {point(), point()};
  return chains;
}

void expect_all_once(const std::vector<Visit>& tour, std::size_t count) {
  std::vector<std::uint32_t> seen;
  for (const Visit visit : tour) seen.push_back(visit.chain);
  std::sort(seen.begin(), seen.end());
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(seen, all);
}

// Every order in every combination of directions.
double brute_force(const std::vector<Ends>& chains, const Eigen::Vector2d& start) {
  std::vector<std::uint32_t> order(chains.size());
  std::iota(order.begin(), order.end(), 0u);
  double best = 1e300;
  do {
    for (unsigned turned = 0; turned < 1u << chains.size(); ++turned) {
      double sum = 0;
      Eigen::Vector2d at = start;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const Ends& chain = chains[order[i]];
        const bool reversed = (turned >> i & 1) != 0;
        sum += (at - (reversed ? chain.last : chain.first)).norm();
        at = reversed ? chain.first : chain.last;
      }
      best = std::min(best, sum);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Tour, FewChainsTakeTheShortestWay) {
  std::mt19937_64 random(71);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const auto chains = random_chains(random, static_cast<std::size_t>(round % 7), round % 2 == 0);
    const Eigen::Vector2d start(1, 2);
    const auto tour = short_tour(chains, start);
    expect_all_once(tour, chains.size());
    EXPECT_NEAR(travel(chains, start, tour), brute_force(chains, start), 1e-9);
  }
}

TEST(Tour, ImprovementIsNearTheBestOfAFewChains) {
  std::mt19937_64 random(72);
  double found = 0, best = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const auto chains = random_chains(random, 6, round % 3 == 0);
    const Eigen::Vector2d start(0, 0);
    auto tour = nearest_neighbour_tour(chains, start);
    expect_all_once(tour, chains.size());
    const double before = travel(chains, start, tour);
    improve(chains, start, tour);
    expect_all_once(tour, chains.size());
    EXPECT_LE(travel(chains, start, tour), before + 1e-9);
    found += travel(chains, start, tour);
    best += brute_force(chains, start);
  }
  EXPECT_GE(found, best - 1e-6);
  EXPECT_LE(found, 1.05 * best);
}

TEST(Tour, ManyChains) {
  std::mt19937_64 random(73);
  for (const std::size_t count : {10u, 11u, 57u, 300u, 5000u})
    for (const bool lattice : {false, true}) {
      SCOPED_TRACE(count);
      const auto chains = random_chains(random, count, lattice);
      const Eigen::Vector2d start(0, 0);
      const auto greedy = nearest_neighbour_tour(chains, start);
      const auto tour = short_tour(chains, start);
      expect_all_once(tour, count);
      EXPECT_LE(travel(chains, start, tour), travel(chains, start, greedy) + 1e-9);
      if (count >= 300 && !lattice) {
        EXPECT_LT(travel(chains, start, tour), 0.92 * travel(chains, start, greedy));
      }
    }
  // All in one place.
  const std::vector<Ends> heap(100, Ends{{3, 4}, {3, 4}});
  EXPECT_EQ(travel(heap, {0, 0}, short_tour(heap, {0, 0})), 5);
}

TEST(Tour, NearestNeighbourGoesToTheNearest) {
  std::mt19937_64 random(74);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    const auto chains = random_chains(random, 1 + random() % 60, round % 2 == 0);
    Eigen::Vector2d at(50, 50);
    std::vector<bool> done(chains.size(), false);
    for (const Visit visit : nearest_neighbour_tour(chains, at)) {
      double nearest = 1e300;
      for (std::size_t i = 0; i < chains.size(); ++i)
        if (!done[i]) nearest = std::min({nearest, (chains[i].first - at).norm(), (chains[i].last - at).norm()});
      const Ends& chain = chains[visit.chain];
      EXPECT_EQ(((visit.reversed ? chain.last : chain.first) - at).norm(), nearest);
      at = visit.reversed ? chain.first : chain.last;
      done[visit.chain] = true;
    }
  }
}

TEST(EndTree, AgainstALookAtEveryPoint) {
  std::mt19937_64 random(75);
  std::vector<std::pair<double, std::uint32_t>> found;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    std::vector<Eigen::Vector2d> points(1 + random() % 90);
    for (auto& p : points) p = {double(random() % 12), double(random() % 12)};
    EndTree tree(points);
    std::vector<bool> gone(points.size(), false);
    for (std::size_t left = points.size(); left > 0; --left) {
      const Eigen::Vector2d to(double(random() % 12), double(random() % 12));
      std::vector<std::pair<double, std::uint32_t>> all;
      for (std::uint32_t i = 0; i < points.size(); ++i)
        if (!gone[i]) all.push_back({(points[i] - to).squaredNorm(), i});
      std::sort(all.begin(), all.end());
      EXPECT_EQ(tree.nearest(to), all[0].second);
      const std::uint32_t self = all[random() % all.size()].second, other = all[random() % all.size()].second;
      tree.nearest(to, 5, self, other, found);
      std::erase_if(all, [&](const auto& p) { return p.second == self || p.second == other; });
      all.resize(std::min<std::size_t>(5, all.size()));
      EXPECT_EQ(found, all);
      tree.remove(self);
      gone[self] = true;
    }
  }
}

}  // namespace
}  // namespace blackleaf::detail
