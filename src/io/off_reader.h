// OFF, read here rather than by assimp, which passes over polygons of ten corners or more, takes comments between faces
// for faces, and rounds to single precision.
#pragma once

#include <string>

#include "blackleaf/mesh.h"
#include "file/input_file.h"

namespace blackleaf::detail {

/// A text OFF file with any of the prefixes ST, C and N, whose additions are passed over, or 4 (points are divided by
/// their fourth coordinate). The word OFF may be missing, and so may the number of edges; a vertex and a face have a
/// line each, with anything behind; '#' begins a comment. Faces of fewer than three corners bound nothing and are
/// passed over. Throws Error(bad_input) for a file that is cut off, contradicts its header, is binary or of another
/// dimension, and for vertices that are not finite; Error(cancelled) when the program is to stop. Memory grows with
/// what has been read, never with what the header promises. Requires: file.is_regular().
TriangleMesh read_off(const InputFile& file, const std::string& name);

}  // namespace blackleaf::detail
