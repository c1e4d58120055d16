// What `draw` draws: files, labels, steps of a path, and what is cut away of them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/frame.h"
#include "blackleaf/scene.h"
#include "labels.h"
#include "motion_options.h"
#include "options.h"
#include "session.h"

namespace blackleaf::cli {

/// A scene and what its solids are called.
struct NamedScene {
  struct Solid {
    std::string name;                    // for layers; empty if there is only one
    std::size_t file = 0;                // its place on the command line
    std::optional<std::uint32_t> label;  // if it is one of many of its file
  };
  Scene scene;
  std::vector<Solid> solids;
};

class SceneArguments {
 public:
  void add_to(App& app);
  /// Throws Error(bad_argument) for forms that are wrong and options that do not go together.
  void check() const;

  std::size_t file_count() const { return files_.size(); }
  bool cut() const { return !cuts_.empty(); }
  /// Throws Error(bad_argument) when a cut is seen edge-on, so that no side of it is the viewer's. `view` may be the
  /// screen of a perspective.
  void require_faced(const View& view) const;
  /// The names of the files, for titles.
  std::string source() const;
  /// Loads everything, as stages "read", "align" and "move". Throws Error(bad_argument) that names both files when
  /// universes or frames differ.
  NamedScene read(Session& session) const;
  /// The scene without what stands before the cuts, seen from `view`. A cut that is seen edge-on is left out; `cut`
  /// says whether any other was made. O(words).
  Scene seen_from(const Scene& scene, const View& view, bool& cut, const Work& work) const;

 private:
  using Planes = std::array<std::optional<std::int32_t>, 3>;
  static Planes parse_cut(const std::string& text);

  std::vector<std::string> files_, cuts_;
  Label label_;
  bool align_ = false;
  std::optional<std::string> path_;
  std::optional<int> steps_;
  LeavingOptions leaving_;
};

}  // namespace blackleaf::cli
