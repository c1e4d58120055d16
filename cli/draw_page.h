// What `draw` makes of a drawing: formats, pages, the order of the pen and what it reports.
#pragma once

#include <optional>
#include <string>

#include "blackleaf/pen_order.h"
#include "blackleaf/picture.h"
#include "options.h"
#include "session.h"

namespace blackleaf::cli {

/// How pictures are written.
enum class PictureFormat { svg, pdf, png, hpgl, dxf, json };

/// --format, --size, --order, --stats and --title, as typed.
class PageArguments {
 public:
  void add_to(App& app);

  /// The format, from the suffix of the output or, for standard output, from --format. Throws Error(bad_argument).
  PictureFormat format(const std::string& output) const;
  /// Checks the other options; `in_voxels` when the output has no page, and so no pens either (`pens`: an option for
  /// them was given). Throws Error(bad_argument).
  void check(bool in_voxels, bool pens) const;

  bool stats() const { return stats_; }
  const std::optional<std::string>& title() const { return title_; }
  const std::optional<std::string>& size() const { return size_; }
  /// The page for layers in voxels; a page of a named size is turned to suit them.
  PageOptions page_for(std::span<const Layer> layers) const;
  /// How lines are to be ordered and joined; none: left as they are.
  std::optional<Joining> joining(PictureFormat format) const;

 private:
  std::optional<std::string> format_, size_, order_, title_;
  bool stats_ = false;
};

/// A picture in the order in which it is written, and what each order costs the pen.
struct OrderedPicture {
  Picture picture;
  PenTravel before, after;
};
OrderedPicture ordered_picture(Picture picture, std::optional<Joining> joining);

/// The picture as text. Requires: neither PDF nor PNG.
std::string text_of(const Picture& picture, PictureFormat format);

/// "pen down 3.41 m, pen up 0.20 m, 812 lifts" before and after, on lines of their own; and as JSON.
std::string stats_text(const PenTravel& before, const PenTravel& after);
Json stats_json(const PenTravel& travel);

}  // namespace blackleaf::cli
