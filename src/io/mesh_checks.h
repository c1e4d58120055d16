// What is plainly wrong with a mesh file, found before anything takes its header at its word.
#pragma once

#include <filesystem>

#include "file/input_file.h"

namespace blackleaf::detail {

/// Whether a file is STL (by suffix) in text. Throws Error(bad_input) when it is STL in binary and has another size
/// than its header tells. Requires: file.is_regular().
bool is_stl_text(const InputFile& file, const std::filesystem::path& path);

/// Throws Error(bad_input) when a PLY or OBJ file (by suffix) is cut off or contradicts itself: an unfinished header,
/// counts of more than there is, vertices without coordinates. Reads the file once at most, in O(1) memory, and leaves
/// all that it does not know to the reader proper. Requires: file.is_regular().
void check_mesh_file(const InputFile& file, const std::filesystem::path& path);

}  // namespace blackleaf::detail
