// VolumeSource: the values of a volume file, slice after slice, in memory for a few slices only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/image_io.h"
#include "io/value_location.h"

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

/// What is known of a volume file once its header has been read and checked.
struct LocatedVolume {
  ImageFormat format = ImageFormat::nrrd;
  ImageInformation information;  // its component: that of the values that a source gives
  ValueLocation location;
};

/// Looks a volume file up, not its values. Throws as open_volume, of which it is the first half. Requires: no folder or
/// stack of pictures.
LocatedVolume locate_volume(const std::filesystem::path& path, const SourceOptions& options = {});

/// The bytes of a file's values, in order.
class ValueBytes {
 public:
  ValueBytes() = default;
  virtual ~ValueBytes() = default;
  ValueBytes(const ValueBytes&) = delete;
  ValueBytes& operator=(const ValueBytes&) = delete;
  virtual void read(std::span<std::uint8_t> bytes) = 0;
  /// After the last value: how many more bytes there are, counted up to `most`.
  virtual std::uint64_t surplus(std::uint64_t most) = 0;
};

/// The offset in its file of the first of so many bytes of raw values.
inline std::uint64_t first_value_at(const ValueLocation& location, std::uint64_t length) {
  return location.offset + (location.at_end ? location.available - length : 0);
}

/// Throws Error(bad_input) if a whole slice of values more is there than the header tells.
void check_surplus(const std::filesystem::path& path, std::int64_t slices, std::uint64_t slice_bytes,
                   std::uint64_t surplus);

/// The source of values whose stored bytes, of the shape of `information`, are these. `location` says how they are
/// stored; its direct must be true.
std::unique_ptr<VolumeSource> direct_source(const std::filesystem::path& path, const ValueLocation& location,
                                            ImageInformation information, std::unique_ptr<ValueBytes> bytes);

/// The source for a volume file or folder of slices, by its name and contents; the header has been checked.
/// Throws Error(bad_argument) for options that do not apply.
std::unique_ptr<VolumeSource> open_volume(const std::filesystem::path& path, const SourceOptions& options = {});

}  // namespace blackleaf::detail
