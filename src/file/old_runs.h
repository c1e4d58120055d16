// The contents of version 1: run lengths under zstd.
#pragma once

#include <string_view>

#include "blackleaf/octree.h"
#include "file/file_header.h"

namespace blackleaf::detail::format {

/// The octree of a file of version 1, through buffers of 64 KiB: memory is that of the octree. Throws Error(bad_input)
/// that begins with `name`.
Octree read_old_runs(const ByteSource& source, std::string_view name, const Header& header);

}  // namespace blackleaf::detail::format
