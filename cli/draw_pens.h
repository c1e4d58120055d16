// The options of `draw` for pens.
#pragma once

#include <optional>
#include <string>

#include "blackleaf/picture.h"
#include "options.h"

namespace blackleaf::cli {

class PenArguments {
 public:
  void add_to(CLI::App& app);
  /// Throws Error(bad_argument) for forms that are wrong.
  void check() const { static_cast<void>(pen()); }
  /// Whether any option was given that says how pens look.
  bool given() const { return pen_width_ || pen_; }
  /// The pen of the only solid.
  Pen pen() const;

 private:
  std::optional<double> pen_width_;
  std::optional<std::string> pen_;
};

}  // namespace blackleaf::cli
