// Triangle meshes in and out.
#pragma once

#include <filesystem>

#include "blackleaf/mesh.h"

namespace blackleaf {

/// Reads any mesh that assimp reads (STL, OBJ, PLY, OFF, glTF, 3MF, ...), all its parts in one, node transformations
/// applied, polygons triangulated. Throws Error(io) when the file cannot be read, Error(bad_input) when it is not a
/// mesh, has no triangles, or has vertices that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Writes .stl (binary), .obj or .ply (binary little-endian) by suffix. Atomic. Throws Error(io), and
/// Error(bad_argument) for other suffixes.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace blackleaf
