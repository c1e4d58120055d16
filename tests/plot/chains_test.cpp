#include "plot/chains.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "plot/dashes.h"
#include "plot/pictures.h"

namespace blackleaf {
namespace {

using test::lattice_lines;
using test::pieces;

// The fewest trails that cover a graph, by counting: half the odd vertices, and one for each part without any.
std::size_t fewest_trails(const Polylines& lines) {
  std::map<std::array<double, 2>, std::size_t> number;
  std::vector<std::size_t> part, degree;
  const auto vertex = [&](const Eigen::Vector2d& p) {
    const auto [at, added] = number.insert({{p[0], p[1]}, number.size()});
    if (added) {
      part.push_back(part.size());
      degree.push_back(0);
    }
    return at->second;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t a = vertex(lines[i].front()), b = vertex(lines[i].back());
    ++degree[a];
    ++degree[b];
    const std::size_t from = part[a], to = part[b];
    for (std::size_t& p : part)
      if (p == from) p = to;
  }
  std::map<std::size_t, std::size_t> odd;
  for (std::size_t v = 0; v < part.size(); ++v) odd[part[v]] += degree[v] % 2;
  std::size_t sum = 0;
  for (const auto& [p, count] : odd) sum += std::max<std::size_t>(1, count / 2);
  return sum;
}

TEST(Chains, FewestAndTheSameLines) {
  std::mt19937_64 random(51);
  for (int round = 0; round < 600; ++round) {
    SCOPED_TRACE(round);
    const Polylines lines = lattice_lines(random, 1 + random() % 40, 2 + static_cast<unsigned>(random() % 12));
    const Polylines chains = detail::joined(lines);
    EXPECT_EQ(pieces(chains), pieces(lines));
    EXPECT_EQ(chains.size(), fewest_trails(lines));
  }
}

TEST(Chains, LongLinesAreJoinedAtTheirEnds) {
  Polylines lines;
  const std::vector<Eigen::Vector2d> bent{{0, 0}, {1, 0}, {1, 1}}, back{{5, 5}, {3, 4}, {1, 1}};
  lines.add(bent);
  lines.add(back);
  const Polylines chains = detail::joined(lines);
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains[0].size(), 5u);
  EXPECT_EQ(pieces(chains), pieces(lines));
}

TEST(Chains, EndsWithinAMillionthOfAMillimetreMeet) {
  Polylines lines;
  lines.add({0, 0}, {10, 10});
  lines.add({10 + 1e-12, 10 - 1e-12}, {20, 0});
  lines.add({10, 10.001}, {10, 20});
  EXPECT_EQ(detail::joined(lines).size(), 2u);
  EXPECT_EQ(detail::joined({}).size(), 0u);
}

// The same walk along a line in small steps, by the pattern at each step's middle.
double drawn_length(const std::vector<double>& dashes, double length) {
  const double period = std::accumulate(dashes.begin(), dashes.end(), 0.0);
  constexpr int kSteps = 20000;
  int drawn = 0;
  for (int i = 0; i < kSteps; ++i) {
    double at = std::fmod((i + 0.5) * length / kSteps, period);
    std::size_t part = 0;
    while (at >= dashes[part]) at -= dashes[part++];
    drawn += part % 2 == 0 ? 1 : 0;
  }
  return length * drawn / kSteps;
}

TEST(Dashes, LengthAndPlace) {
  std::mt19937_64 random(52);
  std::uniform_real_distribution<double> number(0.2, 5);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    std::vector<double> dashes;
    for (std::size_t i = 0, parts = 2 + 2 * (random() % 2); i < parts; ++i) dashes.push_back(number(random));
    std::vector<Eigen::Vector2d> bent{{0, 0}};
    double length = 0;
    for (int k = 0; k < 4; ++k) {
      bent.push_back(bent.back() + Eigen::Vector2d(number(random), k % 2 == 0 ? 0 : number(random)));
      length += (bent[bent.size() - 1] - bent[bent.size() - 2]).norm();
    }
    Polylines lines;
    lines.add(bent);
    const Polylines cut = detail::dashed(lines, dashes);
    double sum = 0;
    for (std::size_t i = 0; i < cut.size(); ++i) {
      double one = 0;
      for (std::size_t k = 0; k + 1 < cut[i].size(); ++k) one += (cut[i][k + 1] - cut[i][k]).norm();
      if (i + 1 < cut.size() && dashes.size() == 2) {
        EXPECT_NEAR(one, dashes[0], 1e-9);
      }
      sum += one;
    }
    EXPECT_NEAR(sum, drawn_length(dashes, length), 1e-2);
  }
  Polylines line;
  line.add({0, 0}, {10, 0});
  EXPECT_EQ(detail::dashed(line, {}), line);
  const Polylines cut = detail::dashed(line, {3, 1});
  ASSERT_EQ(cut.size(), 3u);
  EXPECT_EQ(cut[1].front(), Eigen::Vector2d(4, 0));
  EXPECT_EQ(cut[1].back(), Eigen::Vector2d(7, 0));
  EXPECT_EQ(cut[2].back(), Eigen::Vector2d(10, 0));
}

}  // namespace
}  // namespace blackleaf
