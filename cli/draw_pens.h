// Which lines `draw` draws, with which pens.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blackleaf/hatch.h"
#include "blackleaf/picture.h"
#include "draw_scene.h"
#include "options.h"

namespace blackleaf::cli {

class PenArguments {
 public:
  void add_to(App& app);
  /// Throws Error(bad_argument) for forms that are wrong and options that do not go together; `in_voxels` when the
  /// output has no page, `cut` when the scene is cut open.
  void check(bool in_voxels, bool cut) const;
  /// Throws Error(bad_argument) for what pictures in perspective have none of.
  void check_perspective() const;
  /// Throws Error(bad_argument) for pens of solids that are not there.
  void check(const NamedScene& scene) const;

  /// Whether any option was given that says how pens look.
  bool given() const { return pen_width_ || !pens_.empty(); }
  /// Whether all lines are of one kind.
  bool plain() const { return !outline_width_ && !hatch_ && (!hidden_ || *hidden_ == "none"); }
  bool hatch() const { return hatch_; }
  /// `side`: of the universe.
  SceneOptions lines(std::int32_t side) const;
  /// Distances of hatch lines at a scale; without one, as pictures without a page have it, voxels.
  HatchOptions hatching(std::optional<double> mm_per_voxel, bool cut) const;

  /// The layers of lines, lowest first: hatching, hidden lines, visible ones, outlines; one layer at least.
  std::vector<Layer> layers(const NamedScene& scene, std::vector<SceneLines> lines) const;

 private:
  Pen pen(const NamedScene& scene, std::size_t solid) const;

  std::optional<std::string> hidden_, hatch_spacing_;
  std::optional<double> pen_width_, outline_width_, outline_gap_;
  std::vector<std::string> pens_;
  bool hatch_ = false;
};

}  // namespace blackleaf::cli
