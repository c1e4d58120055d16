// Strokes of pieces that several threads have found (found_pieces.h), beside the same pieces sorted.
#include "draw/strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "blackleaf/drawing.h"
#include "octree/team.h"
#include "reference/sorted_strokes.h"
#include "stroke_laws.h"

namespace blackleaf {
namespace {

using detail::Bounds;
using detail::ClassBuckets;
using detail::ClassLines;
using detail::EdgeFamily;
using detail::FoundPieces;
using detail::PictureLines;
using detail::Piece;

// Pieces of three classes.
using Pieces = std::array<std::vector<Piece>, 3>;

struct Shape {
  std::int64_t keys, positions, lengths;  // how many different ones
  std::size_t count;                      // of a class
};

Pieces random_pieces(const Shape& shape, std::mt19937& random) {
  const auto pick = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  };
  Pieces pieces;
  for (std::vector<Piece>& of : pieces) {
    const std::int64_t key = pick(-shape.keys, shape.keys), position = pick(-shape.positions, shape.positions);
    for (std::size_t i = 0; i < shape.count; ++i) {
      const std::int64_t low = position + pick(0, shape.positions - 1);
      of.emplace_back(key + pick(0, shape.keys - 1), low, low + pick(1, shape.lengths));
    }
  }
  return pieces;
}

class Strokes {
 public:
  explicit Strokes(const Eigen::Vector3d& direction) : view_(direction) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const EdgeFamily family(axis, view_.direction());
      classes_.push_back({family.line_class, PictureLines(family, view_)});
    }
  }

  // One class after the other, sorted as a whole.
  std::vector<Stroke> expected(const Pieces& pieces) const {
    std::vector<Stroke> strokes;
    for (const ClassLines& of : classes_) reference::append_strokes(pieces[of.line_class], of.picture, strokes);
    return strokes;
  }

  // Dealt out to so many finders, at random.
  std::vector<Stroke> found(const Pieces& pieces, std::size_t finders, int bits, int threads,
                            std::mt19937& random) const {
    ClassBuckets buckets;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      Bounds keys;
      for (const Piece& piece : pieces[k]) keys.add(piece.key);
      if (!pieces[k].empty()) buckets[k] = {keys, bits};
    }
    std::vector<std::unique_ptr<FoundPieces>> all;
    for (std::size_t i = 0; i < finders; ++i) all.push_back(std::make_unique<FoundPieces>(buckets));
    for (unsigned k = 0; k < pieces.size(); ++k)
      for (const Piece& piece : pieces[k]) all[random() % finders]->add(k, piece);
    std::vector<FoundPieces*> parts;
    for (const auto& one : all) parts.push_back(one.get());
    std::vector<Stroke> strokes;
    detail::Team::with({threads, {}},
                       [&](detail::Team& team) { strokes = strokes_of(parts, buckets, classes_, team); });
    return strokes;
  }

 private:
  View view_;
  std::vector<ClassLines> classes_;
};

TEST(FoundPieces, AsIfSorted) {
  const std::vector<Shape> shapes = {{1, 1000, 3, 300},
                                     {1000, 1, 1, 500},
                                     {30, 40, 2, 1000},
                                     {1 << 20, 1 << 30, 1 << 20, 700},
                                     {5, 100000, 50, 4000},
                                     {std::int64_t{1} << 40, std::int64_t{1} << 60, 1, 100},
                                     {3, 5, 5, 65},
                                     {100, 100, 100, 1},
                                     {std::int64_t{1} << 40, 4, std::int64_t{1} << 59, 130}};
  std::mt19937 random(60000);
  for (int round = 0; round < 40; ++round)
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      SCOPED_TRACE("round " + std::to_string(round) + ", shape " + std::to_string(s));
      const Strokes strokes(round % 2 ? Eigen::Vector3d(3, -5, 7) : Eigen::Vector3d(1, 1, 1));
      const Pieces pieces = random_pieces(shapes[s], random);
      const auto finders = static_cast<std::size_t>(1 + round % 3);
      expect_same(strokes.found(pieces, finders, round % 9, 1 + round % 2, random), strokes.expected(pieces));
    }
}

// All of one place become one; most buckets keep a piece of a great many.
TEST(FoundPieces, FewAreLeft) {
  std::mt19937 random(60001);
  for (std::size_t count = 1; count < 1000; count += 37) {
    SCOPED_TRACE("count " + std::to_string(count));
    const Strokes strokes(Eigen::Vector3d(1, 2, 3));
    const Pieces pieces = random_pieces({8, 2, 3, count}, random);
    expect_same(strokes.found(pieces, 3, 2, 2, random), strokes.expected(pieces));
  }
}

TEST(FoundPieces, None) {
  std::mt19937 random(60002);
  EXPECT_TRUE(Strokes(Eigen::Vector3d(1, 1, 1)).found({}, 2, 4, 2, random).empty());
}

// Strokes so far out that their ends are one in doubles are left out, by whoever writes them.
TEST(FoundPieces, WhatDrawsNothing) {
  const std::int64_t far = std::int64_t{1} << 60;
  Pieces pieces;
  for (std::int64_t i = 0; i < 200; ++i)
    for (auto& of : pieces) of.emplace_back(i % 7, far + 4 * i, far + 4 * i + (i % 3 ? 1 : 1 << 20));
  std::mt19937 random(60003);
  const Strokes strokes(Eigen::Vector3d(1, 1, 1));
  const std::vector<Stroke> expected = strokes.expected(pieces);
  EXPECT_LT(expected.size(), 600U);
  for (const int threads : {1, 2}) expect_same(strokes.found(pieces, 2, 3, threads, random), expected);
}

}  // namespace
}  // namespace blackleaf
