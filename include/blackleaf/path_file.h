// Paths in files: JSON, as `plan` writes it, `sweep` and `animate` read it, and people write it by hand.
//
//   {"about": [32, 32, 32],
//    "poses": [{"time": 0, "translation": [0, 0, 0], "rotation": [1, 0, 0, 0]},
//              {"time": 2.5, "translation": [10, 0, -4.5], "rotation": [0.7071, 0, 0, 0.7071]}]}
//
// Translations are in voxels, rotations quaternions w,x,y,z, times in seconds. What a pose leaves out is zero, no turn;
// its time it must say. "about" may be left out where no pose turns.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blackleaf/path.h"

namespace blackleaf {

/// What a planner says of the path it found.
struct PathNotes {
  std::vector<double> clearance;  // voxels of free space at each pose; empty if not known
  std::optional<double> length;   // voxels
  std::optional<std::string> planner;
  std::optional<double> seconds;  // that planning took
  std::optional<bool> verified;
};

struct PathFile {
  Path path;
  PathNotes notes;
};

/// Reads a path. Keys of the file that are not known are left aside; unknown keys of a pose, which are likely misspelt,
/// are refused. Throws Error(io), and Error(bad_input) in one line that names the file and the entry.
PathFile read_path(const std::filesystem::path& file);
/// The same from JSON text; `name` is what errors call it.
PathFile path_from_json(const std::string& text, const std::string& name);

/// JSON text, one pose a line, that gives the same path and notes back. Requires: notes.clearance is empty or has one
/// entry a pose.
std::string to_json(const Path& path, const PathNotes& notes = {});
/// Writes it. Atomic. Throws Error(io).
void write_path(const Path& path, const std::filesystem::path& file, const PathNotes& notes = {});

}  // namespace blackleaf
