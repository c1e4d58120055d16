// STL in text, read here rather than by assimp, which knows its words in small letters only, drops the fourth vertex of
// a facet and whole solids, puts those of incomplete facets together, and rounds to single precision.
#pragma once

#include <string>

#include "blackleaf/mesh.h"
#include "file/input_file.h"

namespace blackleaf::detail {

/// All facets of all solids. Words may be in capital letters and stand on any lines; what is neither facet nor vertex
/// (normals, names, colours) is passed over. Throws Error(bad_input) for facets of other than three vertices, vertices
/// outside facets or not of three finite numbers, and files without facets; Error(cancelled) when the program is to
/// stop. Memory grows with what has been read. Requires: file.is_regular().
TriangleMesh read_stl_text(const InputFile& file, const std::string& name);

}  // namespace blackleaf::detail
