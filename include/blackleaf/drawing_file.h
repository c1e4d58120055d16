// Pictures in files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "blackleaf/picture.h"

namespace blackleaf {

/// Pixels, white where nothing is drawn. Throws Error(bad_argument) when a side would have more than 32767 pixels.
std::vector<std::uint8_t> to_png(const Picture& picture, double dots_per_inch = 200);
/// One page, vectors. The same picture gives the same bytes: the date within is fixed.
std::vector<std::uint8_t> to_pdf(const Picture& picture);

/// Writes .svg, .json, .png or .pdf by suffix. Atomic. Throws Error(io), and Error(bad_argument) for other suffixes.
void write_picture(const Picture& picture, const std::filesystem::path& path, double dots_per_inch = 200);
/// The same for a drawing on a page of its own; .json is in voxels then. Throws Error(bad_argument) for a page too
/// small for its margins.
void write_drawing(const LineDrawing& drawing, const std::filesystem::path& path, const PageOptions& page = {});

}  // namespace blackleaf
