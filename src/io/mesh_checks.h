// What is plainly wrong with a mesh file, found before anything takes its header at its word.
#pragma once

#include <filesystem>

#include "file/input_file.h"

namespace blackleaf::detail {

/// Throws Error(bad_input) when a PLY, OFF or STL file (by suffix) is cut off or contradicts its own header: an
/// unfinished header, counts of more than there is, faces with vertices that are not there. Reads the file once at
/// most, in O(1) memory, and leaves all that it does not know to the reader proper. Requires: file.is_regular().
void check_mesh_file(const InputFile& file, const std::filesystem::path& path);

}  // namespace blackleaf::detail
