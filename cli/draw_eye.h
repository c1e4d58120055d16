// The options of `draw` for perspective.
#pragma once

#include <optional>
#include <string>

#include "blackleaf/perspective.h"
#include "options.h"

namespace blackleaf::cli {

class EyeArguments {
 public:
  void add_to(App& app);
  bool given() const { return eye_.has_value(); }
  /// Throws Error(bad_argument) for forms that are wrong and options that do not go together; `other_view` says which
  /// other option gives views, if one does.
  void check(const std::optional<std::string>& other_view) const;
  /// From --eye to --target, or to the middle of what there is. Requires: given().
  Perspective perspective(const Octree& all) const;

 private:
  std::optional<std::string> eye_, target_;
  std::optional<double> field_of_view_;
};

}  // namespace blackleaf::cli
