// Files: octrees in and out by name, "-" for standard input and output, and checks made before any long work.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/octree.h"
#include "blackleaf/octree_file.h"
#include "labels.h"
#include "session.h"

namespace blackleaf::cli {

/// Declares the positional argument for an octree file.
Option* add_octree_input(App& app, const std::string& name, std::string& target,
                         const std::string& description = "octree file, or - for standard input");
/// Declares the required -o.
Option* add_output(App& app, std::string& target, const std::string& description);

/// Throws Error(io) unless `path` names a file that is there. `what` says what it should be, e.g. "a mesh or volume".
void check_input(const std::string& path, const std::string& what);
/// The same for formats that must be read from a file: throws Error(io) for pipes and devices too, which have no
/// beginning to go back to and may keep us waiting for ever.
void check_plain_input(const std::string& path, const std::string& what);
/// The same where a folder is as good as a file.
void check_input_or_folder(const std::string& path, const std::string& what);
/// The same for octree files: refuses named pipes as well.
void check_octree_input(const std::string& path);
/// Throws Error(io) when `path` plainly cannot be written: its folder is missing or closed to us, or it is a
/// folder.
void check_output(const std::string& path);
/// The same for an octree; refuses suffixes of other formats, and "-" when standard output is a terminal or is to carry
/// JSON.
void check_octree_output(const Session& session, const std::string& path);

/// Loads an octree, as stage "read".
OctreeFile read_octree(Session& session, const std::string& path);
/// Loads a solid that is to be compared voxel by voxel with one that was loaded before, as read_solid() does. Throws
/// Error(bad_argument) when their depths differ, with `remedy`; warns when their frames do.
Octree read_beside(Session& session, const Octree& first, const std::string& first_name, const std::string& name,
                   const Label& label, const std::string& remedy = "build both in one universe, with build --like");
/// The check of two that are loaded already.
void check_one_universe(const Session& session, const Octree& first, const std::string& first_name, const Octree& next,
                        const std::string& name, const std::string& remedy);
/// For --align: throws Error(bad_argument) unless the voxels of both lie on each other in the world.
void check_lattice(const Octree& first, const std::string& first_name, const Octree& other, const std::string& name);
/// Throws Error(bad_argument) that names both sizes when the voxels of two solids, in the world, are of different ones.
void check_voxel_sizes(const Octree& first, const std::string& first_name, const Octree& other,
                       const std::string& name);
/// All bytes of a file, or of standard input for "-". Throws Error(io).
std::vector<std::uint8_t> read_bytes(const std::string& path);
/// True iff the bytes begin as those of an octree file do, whatever follows.
bool is_octree_data(const std::vector<std::uint8_t>& bytes);

/// What an octree file says of where it comes from: program, command, source (the input as typed) and options.
std::string metadata_text(const Session& session, const std::string& source, const Json& options);
/// Sends what `bytes` returns to standard output, as stage "write".
void print_octree_bytes(Session& session, const std::function<std::vector<std::uint8_t>()>& bytes);

/// Saves an octree, as stage "write", with metadata that say which program, command, source and options made it.
/// `source` is the input as typed. Then tells what was written: one line, or with --json an object that starts with the
/// same facts and ends with `more`; `before` is printed first, even under --quiet, unless with --json; else nothing
/// under --quiet. What it tells is measured before the file is put in place, so that an interrupt can come no later.
void write_octree(Session& session, const Octree& octree, const std::string& path, const std::string& source,
                  const Json& options, const Json& more = Json::object(), const std::string& before = {});
void write_octree(Session& session, const Made& made, const std::string& path, const std::string& source,
                  const Json& options, const Json& more = Json::object(), const std::string& before = {});
/// Warns if a result holds nothing.
void warn_if_empty(const Session& session, const Octree& octree);
void warn_if_empty(const Session& session, const Made& made);

/// The name without its folders; "-" becomes "standard input".
std::string base_name(const std::string& path);
/// The suffix in lower case, e.g. ".stl"; ".nii.gz" counts as one.
std::string suffix_of(const std::string& path);
/// Bytes in a file; none for what is no plain file.
std::optional<std::uint64_t> size_of(const std::string& path);
/// "1 voxel", "2,176 voxels".
std::string counted(std::uint64_t number, const std::string& noun);
/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t number);

}  // namespace blackleaf::cli
