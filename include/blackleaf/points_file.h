// Point clouds from files, piece by piece.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "blackleaf/work.h"

namespace blackleaf {

/// What a file of points holds.
struct PointsInfo {
  std::uint64_t points = 0;      // all of them
  std::uint64_t not_finite = 0;  // of these, with a coordinate that is NaN or infinite, which is how sensors say "none"
  Eigen::AlignedBox3d box;       // of the others
};

/// True iff a file holds points by its suffix (.pcd .xyz .xyzn .xyzrgb .pts .asc .txt .csv), or is a PLY file without
/// faces. Throws Error(io) when a PLY file cannot be read, Error(bad_input) when its header is damaged.
bool is_point_cloud(const std::filesystem::path& path);

/// Reads the points of a file and hands them to `take` in pieces, in the file's order, those that are not finite too.
/// Coordinates are as the file has them, in double precision; PCD's viewpoint is not applied. Formats, by suffix:
///
/// - .ply: ASCII and binary of either byte order, all number types, vertices with any other properties, lists too;
///   faces and other elements are passed over;
/// - .pcd: ASCII, binary and compressed binary;
/// - .xyz, .pts, .txt, .csv and all other suffixes of is_point_cloud: text, a point a line, x, y and z first, or in the
///   columns of these names if the first line has names. Columns are separated by blanks, or by commas, or by
///   semicolons. Comments begin with # or //. A line of one whole number, as in .pts, tells how many points follow.
/// - all other meshes (mesh_file.h): their vertices.
///
/// Memory does not grow with the file, except for compressed PCD and for meshes. Throws Error(io) when the file cannot
/// be read, Error(bad_input) when it is damaged: lengths that are not true, lines without three numbers; the message
/// names the line or the point.
PointsInfo read_points(const std::filesystem::path& path,
                       const std::function<void(std::span<const Eigen::Vector3d>)>& take, const Work& work = {});

}  // namespace blackleaf
