// Drawings by Cairo: pixels and PDF pages, in memory. Only cairo_page.cpp sees Cairo.
#pragma once

#include <cstdint>
#include <vector>

#include "io/page.h"

namespace blackleaf::detail {

/// Black strokes on white. Throws Error(bad_argument) when the picture would have a side of more than 32767 pixels.
std::vector<std::uint8_t> png_bytes(const LineDrawing& drawing, const PageOptions& options);
std::vector<std::uint8_t> pdf_bytes(const LineDrawing& drawing, const PageOptions& options);

}  // namespace blackleaf::detail
