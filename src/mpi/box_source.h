// BoxSource: a box of a volume's values as a volume of its own, slice by slice.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>

#include "io/volume_source.h"
#include "stretch.h"

namespace blackleaf::mpi {

/// A volume that several ranks read from.
class SharedVolume {
 public:
  SharedVolume() = default;
  virtual ~SharedVolume() = default;
  SharedVolume(const SharedVolume&) = delete;
  SharedVolume& operator=(const SharedVolume&) = delete;

  /// The box in coordinates of the volume. The source lives no longer than this.
  virtual std::unique_ptr<detail::VolumeSource> box(const VoxelBox& box) = 0;
};

/// Raw values in a file, through MPI-IO. `turn` is held while MPI is called. Throws Error(io) that begins with `path`.
std::unique_ptr<SharedVolume> open_raw(const std::filesystem::path& path, const detail::LocatedVolume& volume,
                                       std::mutex& turn);

/// A dataset of an HDF5 file, through parallel HDF5: three dimensions, the last the fastest, which is x. Its voxels
/// have the sides that an attribute element_size_um (of z, y, x) tells, or side 1 mm.
detail::ImageInformation hdf5_information(const std::filesystem::path& path, std::string& dataset);
std::unique_ptr<SharedVolume> open_hdf5(const std::filesystem::path& path, const std::string& dataset,
                                        const detail::ImageInformation& information, std::mutex& turn);

/// The information of a box: the same values in another shape.
inline detail::ImageInformation of_box(detail::ImageInformation information, const VoxelBox& box) {
  information.size.clear();
  for (std::size_t i = 0; i < 3; ++i) information.size.push_back(box.high[i] - box.low[i]);
  return information;
}

}  // namespace blackleaf::mpi
