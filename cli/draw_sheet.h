// --sheet of `draw`: four views on a framed page.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/frame.h"
#include "blackleaf/sheet.h"
#include "options.h"

namespace blackleaf::cli {

class SheetArguments {
 public:
  void add_to(App& app);
  bool given() const { return sheet_; }
  /// Throws Error(bad_argument) for options that want --sheet where it is not given, and for forms that are wrong.
  /// `size` is --size as typed.
  void check(const std::optional<std::string>& size) const;

  /// What the sheet is to say and show. `frame` tells a voxel's size.
  SheetOptions options(const std::optional<std::string>& size, const std::string& title, const std::string& source,
                       const Frame& frame) const;

 private:
  ProjectionAngle angle() const;
  double scale() const;

  bool sheet_ = false;
  std::optional<std::string> angle_, scale_, date_;
};

}  // namespace blackleaf::cli
