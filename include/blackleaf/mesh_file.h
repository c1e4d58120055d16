// Triangle meshes in and out.
#pragma once

#include <filesystem>

#include "blackleaf/mesh.h"

namespace blackleaf {

/// Reads any mesh that assimp reads (STL, OBJ, PLY, glTF, 3MF, ...), and OFF and STL in text: all its parts in one, as
/// often as its nodes refer to them, node transformations applied, polygons of any number of corners divided into
/// triangles; points and lines are passed over. Positions are in double precision from OFF and text STL and in single
/// from the others. assimp works in a child process, which damaged files may crash, or make run into limits of memory
/// and processor time, with no harm to this one; the program needs no provision for it but must not wait for all
/// children in another thread. Throws Error(io) when the file cannot be read or no process can be started;
/// Error(bad_input) when it is not a mesh, has no triangles, has vertices that are not finite, or ends the child;
/// Error(cancelled) when the program was told to stop, at once, or when someone ended the child by SIGINT, SIGTERM,
/// SIGHUP or SIGQUIT: Ctrl-C reaches it, too.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Writes .stl (binary), .obj or .ply (binary little-endian) by suffix. Atomic. Throws Error(io), and
/// Error(bad_argument) for other suffixes.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace blackleaf
