// Which pen draws what: the options of `draw` for pens, and the layers they make.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blackleaf/picture.h"
#include "options.h"

namespace blackleaf::cli {

/// What is seen of one solid, by kinds of lines.
struct SolidLines {
  std::vector<Stroke> outline, inner, hidden;
};

enum class HiddenLines { none, dashed, only };

class PenArguments {
 public:
  void add_to(CLI::App& app);
  /// Throws Error(bad_argument) for forms that are wrong, and for more pens than solids.
  void check(std::size_t solids) const;

  HiddenLines hidden() const;
  bool outline() const { return outline_width_.has_value(); }
  /// Whether any option was given that says how pens look.
  bool given() const { return pen_width_ || outline_width_ || !pens_.empty(); }
  /// The layers of solids of these names, hidden lines lowest, outlines on top. Layers without lines are left out, but
  /// not the last.
  std::vector<Layer> layers(std::span<const std::string> names, std::vector<SolidLines> solids) const;

 private:
  Pen pen(std::size_t solid, std::size_t solids) const;

  std::optional<std::string> hidden_;
  std::optional<double> pen_width_, outline_width_;
  std::vector<std::string> pens_;
};

}  // namespace blackleaf::cli
