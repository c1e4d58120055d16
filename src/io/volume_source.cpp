#include "io/volume_source.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/header_text.h"
#include "io/inflating_file.h"
#include "io/length_unit.h"
#include "io/slice_stack.h"
#include "io/text_values.h"
#include "io/volume_header.h"
#include "io/volume_shape.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

class RawBytes : public ValueBytes {
 public:
  RawBytes(const ValueLocation& location, std::uint64_t length)
      : file_(location.file), at_(first_value_at(location, length)), end_(location.offset + location.available) {}
  void read(std::span<std::uint8_t> bytes) override {
    file_.read_at(at_, bytes);
    at_ += bytes.size();
  }
  std::uint64_t surplus(std::uint64_t most) override { return std::min(end_ - at_, most); }

 private:
  const InputFile file_;
  std::uint64_t at_, end_;
};

class PackedBytes : public ValueBytes {
 public:
  PackedBytes(const fs::path& path, const ValueLocation& location)
      : file_(path, location.file, location.offset, location.available) {
    std::vector<std::uint8_t> scratch(std::size_t{1} << 16);
    for (std::uint64_t left = location.before; left > 0;) {
      const auto part =
          std::span(scratch).first(static_cast<std::size_t>(std::min<std::uint64_t>(left, scratch.size())));
      file_.read(part);
      left -= part.size();
    }
  }
  void read(std::span<std::uint8_t> bytes) override { file_.read(bytes); }
  std::uint64_t surplus(std::uint64_t most) override { return file_.finish(most); }

 private:
  InflatingFile file_;
};

template <class T>
void swap_bytes(void* values, std::size_t count) {
  auto* const bytes = static_cast<unsigned char*>(values);
  for (std::size_t i = 0; i < count; ++i) std::reverse(bytes + i * sizeof(T), bytes + (i + 1) * sizeof(T));
}

void swap_bytes(void* values, std::size_t count, std::size_t size) {
  switch (size) {
    case 2:
      return swap_bytes<std::uint16_t>(values, count);
    case 4:
      return swap_bytes<std::uint32_t>(values, count);
    case 8:
      return swap_bytes<std::uint64_t>(values, count);
    default:
      return;
  }
}

// NIfTI's values, in doubles: floats would lose the last bits of 32-bit whole numbers.
void rescale(Component type, const void* stored, double* values, std::size_t count, double slope, double intercept) {
  with_type_of(type, [&]<class Stored>(Stored) {
    const auto* const from = static_cast<const Stored*>(stored);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(from[i]) * slope + intercept;
  });
}

std::uint64_t slice_values(const ImageInformation& information) {
  const auto size = solid_size(information);
  return static_cast<std::uint64_t>(size[0] * size[1]);
}

// Values that stand one behind the other, in the file or once unpacked.
class DirectSource : public VolumeSource {
 public:
  DirectSource(fs::path path, const ValueLocation& location, ImageInformation information,
               std::unique_ptr<ValueBytes> bytes)
      : path_(std::move(path)),
        information_(std::move(information)),
        slice_(slice_values(information_)),
        left_(solid_size(information_)[2]),
        swapped_(location.swapped),
        stored_(location.stored.value_or(*information_.component)),
        slope_(location.slope),
        intercept_(location.intercept),
        scaled_(location.scaled()),
        bytes_(std::move(bytes)) {}

  const ImageInformation& information() const override { return information_; }

  void read(std::int64_t slices, void* values) override {
    const std::uint64_t count = slice_ * static_cast<std::uint64_t>(slices);
    if (scaled_)
      read_scaled(count, static_cast<double*>(values));
    else
      read_stored(count, static_cast<std::uint8_t*>(values));
    left_ -= slices;
    if (left_ == 0) check_end();
  }

 private:
  std::uint64_t slice_bytes() const { return slice_ * bytes_of(stored_); }

  void read_stored(std::uint64_t count, std::uint8_t* values) {
    bytes_->read({values, count * bytes_of(stored_)});
    if (swapped_) swap_bytes(values, count, bytes_of(stored_));
  }

  void read_scaled(std::uint64_t count, double* values) {
    constexpr std::uint64_t kAtOnce = 1 << 14;
    scratch_.resize(kAtOnce * bytes_of(stored_));
    for (std::uint64_t done = 0; done < count; done += kAtOnce) {
      const std::uint64_t part = std::min(kAtOnce, count - done);
      read_stored(part, scratch_.data());
      rescale(stored_, scratch_.data(), values + done, part, slope_, intercept_);
    }
  }

  void check_end() { check_surplus(path_, solid_size(information_)[2], slice_bytes(), bytes_->surplus(slice_bytes())); }

  fs::path path_;
  ImageInformation information_;
  std::uint64_t slice_;  // values of a slice
  std::int64_t left_;    // slices
  bool swapped_;
  Component stored_;
  double slope_, intercept_;
  bool scaled_;
  std::unique_ptr<ValueBytes> bytes_;
  std::vector<std::uint8_t> scratch_;
};

// Values that only the format's library finds: all of them are read at once.
class WholeSource : public VolumeSource {
 public:
  WholeSource(fs::path path, std::unique_ptr<ImageReader> reader, ImageInformation information)
      : path_(std::move(path)), reader_(std::move(reader)), information_(std::move(information)) {}

  const ImageInformation& information() const override { return information_; }

  void read(std::int64_t slices, void* values) override {
    const std::uint64_t slice = slice_values(information_) * bytes_of(*information_.component);
    if (!values_) {
      const std::uint64_t bytes = slice * static_cast<std::uint64_t>(solid_size(information_)[2]);
      values_.reset(static_cast<std::uint8_t*>(std::calloc(bytes, 1)));
      if (!values_)
        refuse(path_, fmt::format("needs {} bytes of memory, more than there are", bytes), "crop or resample it first");
      reader_->read(values_.get());
    }
    const std::uint64_t length = slice * static_cast<std::uint64_t>(slices);
    std::memcpy(values, values_.get() + at_, length);
    at_ += length;
  }

 private:
  struct Free {
    void operator()(std::uint8_t* memory) const { std::free(memory); }
  };
  fs::path path_;
  std::unique_ptr<ImageReader> reader_;
  ImageInformation information_;
  std::unique_ptr<std::uint8_t[], Free> values_;
  std::uint64_t at_ = 0;
};

}  // namespace

LocatedVolume locate_volume(const fs::path& path, const SourceOptions& options) {
  if (!options.series.empty() || options.spacing)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{}: a {} is given, but it is neither DICOM nor a stack of pictures", path.string(),
                            options.spacing ? "spacing" : "series"),
                "leave it out");
  const auto format = image_format(path);
  if (const InputFile file(path); !file.is_regular())
    throw Error(ErrorCode::io, path.string() + ": is not an ordinary file", "copy it to one first");
  else if (file.size() == 0)
    refuse(path, "is empty", kAgain);
  if (has_slice_suffix(path))
    refuse(path, "is neither DICOM nor TIFF nor PNG",
           "its contents are not what its name says; check where it comes from");
  if (!format)
    refuse(path, "has no suffix of a volume",
           "use .nrrd, .nhdr, .nii, .nii.gz, .mha, .mhd, .hdr or .img, a DICOM, TIFF or PNG file, or a folder of them");
  LocatedVolume volume;
  volume.format = *format;
  volume.location = check_header(path, *format);
  volume.information = ImageReader(path, *format).information();
  check_shape(path, volume.information);
  const ValueLocation& location = volume.location;
  const Component stored = location.stored.value_or(*volume.information.component);
  apply_units(path, *format, volume.information.geometry, options.warn);
  if (location.stored) volume.information.component = location.scaled() ? Component::f64 : stored;
  const auto size = solid_size(volume.information);
  const auto voxels = static_cast<std::uint64_t>(size[0] * size[1] * size[2]);  // at most 2^60
  check_believable(path, location, voxels, voxels * bytes_of(stored));
  if (location.packing == Packing::text && location.known) check_text_values(path, location, stored, voxels);
  if (location.packing == Packing::hex) check_hex_values(path, location, 2 * voxels * bytes_of(stored));
  return volume;
}

// Padding behind the values is common; a whole slice of them more is a header that is wrong.
void check_surplus(const fs::path& path, std::int64_t slices, std::uint64_t slice_bytes, std::uint64_t surplus) {
  if (surplus >= slice_bytes)
    refuse(path, fmt::format("its header tells of {} slices, but there are values for more", slices),
           "mend the size in its header");
}

std::unique_ptr<VolumeSource> direct_source(const fs::path& path, const ValueLocation& location,
                                            ImageInformation information, std::unique_ptr<ValueBytes> bytes) {
  return std::make_unique<DirectSource>(path, location, std::move(information), std::move(bytes));
}

std::unique_ptr<VolumeSource> open_volume(const fs::path& path, const SourceOptions& options) {
  if (is_stack(path)) return open_stack(path, options);
  LocatedVolume volume = locate_volume(path, options);
  const ValueLocation& location = volume.location;
  if (!location.direct)
    return std::make_unique<WholeSource>(path, std::make_unique<ImageReader>(path, volume.format),
                                         std::move(volume.information));
  std::unique_ptr<ValueBytes> bytes;
  if (location.packing == Packing::compressed) {
    bytes = std::make_unique<PackedBytes>(path, location);
  } else {
    const Component stored = location.stored.value_or(*volume.information.component);
    const auto slices = static_cast<std::uint64_t>(solid_size(volume.information)[2]);
    bytes = std::make_unique<RawBytes>(location, slice_values(volume.information) * slices * bytes_of(stored));
  }
  return direct_source(path, location, std::move(volume.information), std::move(bytes));
}

}  // namespace blackleaf::detail
