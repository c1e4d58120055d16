// Motion options: --rotate, --translate, --about and --matrix, as `move` and `collide` share them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blackleaf/lattice.h"
#include "blackleaf/motion.h"
#include "blackleaf/move.h"
#include "blackleaf/octree.h"
#include "session.h"

namespace blackleaf::cli {

class MotionOptions {
 public:
  /// Declares the options; `of` says what moves, e.g. "the solid".
  void add_to(App& app, const std::string& of);

  /// Declares --reflect.
  void add_reflection_to(App& app, const std::string& of);

  /// True iff any of them was given.
  bool given() const { return !rotations_.empty() || translation_ || matrix_ || about_ || reflect_; }
  /// True iff one of those was given that can move anything; --about alone cannot.
  bool moves() const { return !rotations_.empty() || translation_ || matrix_ || reflect_; }
  /// The motion X' = R (X - c) + c + T: all rotations in order, about c, then the translation. Reads the matrix file.
  /// Of a solid that is reflected it is what is left to do after reflection(). Throws Error(bad_argument), and
  /// Error(io) or Error(bad_input) for the matrix file.
  Motion motion(const Octree& octree) const;
  /// What --reflect says, to be done first, about the universe's centre. Throws Error(bad_argument).
  LatticeSymmetry reflection() const;
  /// The options as typed, for a file's metadata; the matrix by its entries.
  Json as_json(const Motion& motion) const;

 private:
  std::vector<std::string> rotations_;
  std::optional<std::string> translation_, matrix_, about_, reflect_;
};

/// The 4x4 rigid matrix in a text file: sixteen numbers row by row, separated by white space, commas or brackets; the
/// last row is 0 0 0 1. Throws Error(io), and Error(bad_input) that says how it is not rigid.
Motion read_matrix(const std::string& path);

/// --clip and --grow, as `translate` and `move` share them.
class LeavingOptions {
 public:
  /// Declares the options.
  void add_to(App& app);
  Leaving choice() const { return clip_ ? Leaving::clip : grow_ ? Leaving::grow : Leaving::error; }
  /// "clip", "grow" or "error".
  std::string name() const { return clip_ ? "clip" : grow_ ? "grow" : "error"; }

 private:
  bool clip_ = false, grow_ = false;
};

}  // namespace blackleaf::cli
