// collide --path: the first contact of B on its way along a path.
#pragma once

#include <optional>
#include <string>

#include "blackleaf/octree.h"
#include "session.h"

namespace blackleaf::cli {

class CollidePath {
 public:
  /// Declares --path, --clearance and --tolerance.
  void add_to(App& app);
  bool given() const { return path_.has_value(); }
  /// Throws Error(bad_argument) when the path is to come from standard input, and so is an octree; when it is beside
  /// options that ask something else; when --clearance or --tolerance are given without it.
  void check(const std::string& a_name, const std::string& b_name, bool something_else) const;
  /// Reads the path, answers, and prints the answer. True iff they meet.
  bool answer(Session& session, const Octree& a, const Octree& b) const;

 private:
  std::optional<std::string> path_;
  std::optional<double> clearance_, tolerance_;
};

}  // namespace blackleaf::cli
