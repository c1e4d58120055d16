// VolumeSource: the values of a volume file, slice after slice, in memory for a few slices only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "io/image_io.h"

namespace blackleaf::detail {

/// What every kind of volume gives to whoever builds from it: what its header says, then its slices in order (a slice
/// is all values of one z, x fastest). Throws Error(io) and Error(bad_input) that begin with the file's name.
class VolumeSource {
 public:
  VolumeSource() = default;
  virtual ~VolumeSource() = default;
  VolumeSource(const VolumeSource&) = delete;
  VolumeSource& operator=(const VolumeSource&) = delete;

  virtual const ImageInformation& information() const = 0;
  /// The next `slices` slices, in the byte order of this machine. Requires: room for them, and that so many are left.
  virtual void read(std::int64_t slices, void* values) = 0;
};

/// The source for a volume file or folder of slices, by its name and contents; the header has been checked.
std::unique_ptr<VolumeSource> open_volume(const std::filesystem::path& path);

}  // namespace blackleaf::detail
