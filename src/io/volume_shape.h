// The shape and the place of a volume, from what its header says.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "blackleaf/frame.h"
#include "blackleaf/voxels.h"
#include "io/image_io.h"

namespace blackleaf::detail {

/// Voxels along x, y, z. Requires: check_shape() has passed the information.
std::array<std::int64_t, 3> solid_size(const ImageInformation& information);

/// Throws Error(bad_input) that begins with the file's name, unless this is a volume of one number a voxel, in three
/// dimensions (or fewer; those beyond may have one voxel), no side over 2^20, with axes that span space.
void check_shape(const std::filesystem::path& path, const ImageInformation& information);

struct PlacedVolume {
  VolumePlacement placement;
  Frame frame;  // of the universe
};

/// The volume at the corner of the universe, or in its centre; `depth` 0 is the smallest that holds it. Throws
/// Error(bad_input) that begins with the file's name when it does not fit. Requires: as solid_size; depth in 0..20.
PlacedVolume place_volume(const std::filesystem::path& path, const ImageInformation& information, int depth,
                          bool centre);

/// The first voxel of the volume in a universe of this frame, shifted by whole voxels; it may lie outside. Throws
/// Error(bad_input) that begins with the file's name when the volume's voxels are not those of the frame.
std::array<std::int64_t, 3> corner_in(const std::filesystem::path& path, const ImageInformation& information,
                                      const Frame& frame);

}  // namespace blackleaf::detail
