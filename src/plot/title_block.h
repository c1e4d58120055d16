// The frame and the title block of an engineering sheet.
#pragma once

#include "blackleaf/sheet.h"

namespace blackleaf::detail {

inline constexpr double kLeftMargin = 20, kMargin = 10;        // of the frame, ISO 5457
inline constexpr double kBlockWidth = 180, kBlockHeight = 28;  // ISO 7200

/// The layers "frame", "title block" and "text", in millimetres on the page. Requires: room for the block.
std::vector<Layer> title_block(const SheetOptions& options, double scale);

}  // namespace blackleaf::detail
