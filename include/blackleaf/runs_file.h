// Run streams as text: one "count colour" line a run, in Millar order.
#pragma once

#include <filesystem>

#include "blackleaf/label_map.h"
#include "blackleaf/octree.h"

namespace blackleaf {

/// Writes the runs of an octree (colours 1 and 0). Atomic. Throws Error(io).
void write_runs(const Octree& octree, const std::filesystem::path& path);
/// Reads them back: the counts must add up to 8^n for some n in 1..20; any colour but 0 is black. Throws Error(io), and
/// Error(bad_input) with the line that is wrong.
Octree read_runs(const std::filesystem::path& path);

/// Writes the runs of a label map, colours being labels. Atomic. Throws Error(io).
void write_runs(const LabelMap& labels, const std::filesystem::path& path);
/// Reads them back: as read_runs(), but every colour is kept.
LabelMap read_label_runs(const std::filesystem::path& path);

}  // namespace blackleaf
