// Octrees of volumes that many ranks read together, each its own stretch of the curve (docs/MPI.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "blackleaf/volume_file.h"
#include "blackleaf/work.h"
#include "ranks.h"
#include "shared_file.h"

namespace blackleaf::mpi {

struct VolumePartOptions {
  VolumeOptions volume;
  /// Place the volume in this universe, shifted by whole voxels, instead of one of its own.
  std::optional<Frame> frame = {};
  std::string dataset = {};  // of an HDF5 file; empty: the only one of three dimensions
  /// Bytes that a rank may hold; 0: as many as it likes.
  std::uint64_t memory_limit = 0;
};

/// The octree that read_volume() makes. The first rank reads the header and tells the others; then every rank reads its
/// stretch, as boxes of blocks of 64^3 voxels, and builds from it as one machine does from a whole volume. For raw
/// NRRD, MetaImage and NIfTI files through MPI-IO, for HDF5 through parallel HDF5. Throws as read_volume, and
/// Error(bad_argument) for values that only one process can unpack, and when a rank would need more than the limit,
/// with what it would need. Progress is this rank's share. A meeting.
SharedOctree read_volume(Ranks& ranks, const std::filesystem::path& path, const VolumePartOptions& options,
                         const Work& work);

/// True iff the name is one of HDF5: .h5 .hdf5 .hdf .nxs.
bool is_hdf5_name(const std::filesystem::path& path);

}  // namespace blackleaf::mpi
