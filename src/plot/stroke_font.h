// Letters drawn by single strokes, so that a pen can write them.
#pragma once

#include <string>
#include <string_view>

#include "blackleaf/picture.h"

namespace blackleaf::detail {

/// Width of a line of text, millimetres, without the space behind its last letter. `height_mm` is that of capitals.
double text_width(std::string_view text, double height_mm);

/// Adds a line of text whose baseline begins at `at`. ASCII has letters; every other character (UTF-8) is a box.
void write_text(Polylines& lines, std::string_view text, const Eigen::Vector2d& at, double height_mm);

/// The text, or as much of its beginning as has room before "...".
std::string shortened(std::string_view text, double height_mm, double room_mm);

}  // namespace blackleaf::detail
