// Picture options: --view, --size and --pen-width, as `draw` and `animate` share them.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "blackleaf/drawing_file.h"
#include "options.h"
#include "session.h"

namespace blackleaf::cli {

class PictureOptions {
 public:
  /// Declares --size and --pen-width.
  void add_to(App& app);

  /// Reads --size. Throws Error(bad_argument) for values out of range and for options that do not apply to pictures of
  /// this kind: "svg", "png", "pdf", "json", or anything else, which has no page.
  void check(const std::string& kind);

  /// The page of a picture that fills `box`; a named page lies down for one that is wider than high. Requires: check()
  /// has been called.
  PageOptions page(const Eigen::AlignedBox2d& box) const;

 private:
  std::optional<std::string> size_text_;
  std::optional<double> pen_width_;
  PageSize size_;
};

/// The box around a drawing, empty if there is nothing in it.
Eigen::AlignedBox2d box_of(const LineDrawing& drawing);

/// --view as a direction. Throws Error(bad_argument).
View parse_view(const std::string& text);

}  // namespace blackleaf::cli
