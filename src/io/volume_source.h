// VolumeSource: the values of a volume file, slice after slice, in memory for a few slices only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

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

/// What may be said of a volume besides where it is; VolumeOptions tells what each means.
struct SourceOptions {
  std::string series = {};
  std::optional<std::array<double, 3>> spacing = {};
  std::function<void(const std::string&)> warn = {};
};

/// The source for a volume file or folder of slices, by its name and contents; the header has been checked.
/// Throws Error(bad_argument) for options that do not apply.
std::unique_ptr<VolumeSource> open_volume(const std::filesystem::path& path, const SourceOptions& options = {});

}  // namespace blackleaf::detail
