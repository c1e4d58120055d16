// Tours: the order and the directions in which chains are drawn. A travelling salesman's problem in which every town
// has two gates: whoever enters by one leaves by the other.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace blackleaf::detail {

/// The two ends of a chain.
struct Ends {
  Eigen::Vector2d first, last;
};

/// One chain of a tour; drawn from its last point to its first if `reversed`.
struct Visit {
  std::uint32_t chain = 0;
  bool reversed = false;
};

/// Travel from `start` to the first chain, between chains and no farther.
double travel(std::span<const Ends> chains, const Eigen::Vector2d& start, std::span<const Visit> tour);

/// A short tour of all chains: the shortest for up to nine (Held and Karp 1962), else nearest neighbour improved by
/// 2-opt and Or-opt moves between near ends. Requires: fewer than 2^31 chains.
std::vector<Visit> short_tour(std::span<const Ends> chains, const Eigen::Vector2d& start);

/// The two parts of short_tour() for many chains.
std::vector<Visit> nearest_neighbour_tour(std::span<const Ends> chains, const Eigen::Vector2d& start);
void improve(std::span<const Ends> chains, const Eigen::Vector2d& start, std::vector<Visit>& tour);

}  // namespace blackleaf::detail
