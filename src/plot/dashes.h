// Dashes as lines of their own, for devices that know none.
#pragma once

#include <vector>

#include "blackleaf/picture.h"

namespace blackleaf::detail {

/// What a pen with these dashes (on, off, on, off ...) draws of each polyline; the pattern starts anew with each. The
/// lines themselves without dashes. Requires: an even number of positive lengths.
Polylines dashed(const Polylines& lines, const std::vector<double>& dashes_mm);

}  // namespace blackleaf::detail
