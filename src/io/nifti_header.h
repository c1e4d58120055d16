// The 348 bytes that open a NIfTI-1 or Analyze 7.5 file.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>

#include "io/image_io.h"

namespace blackleaf::detail {

/// The header is .nii itself, or .hdr beside .img or .img.gz.
struct NiftiFiles {
  std::filesystem::path header, data;
  bool compressed = false;
};
NiftiFiles nifti_files(const std::filesystem::path& path);

/// A header in either byte order.
class NiftiHeader {
 public:
  static constexpr unsigned kBytes = 348;
  /// Throws Error(bad_input) unless it is one of the first version, Error(io).
  explicit NiftiHeader(const NiftiFiles& files);

  /// The number at a byte of the header.
  template <class T>
  T get(std::size_t at) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), bytes_.data() + at, sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  /// True if header and values have the other byte order than this machine.
  bool swapped() const { return swapped_; }
  int dimension(std::size_t i) const { return get<std::int16_t>(40 + 2 * i); }
  double spacing(std::size_t i) const { return get<float>(76 + 4 * i); }
  double data_offset() const { return get<float>(108); }
  double slope() const { return get<float>(112); }
  double intercept() const { return get<float>(116); }
  bool one_file() const { return bytes_.compare(344, 3, "n+1") == 0; }
  bool two_files() const { return bytes_.compare(344, 3, "ni1") == 0; }
  /// Analyze 7.5, where several fields have no such meaning.
  bool is_nifti() const { return one_file() || two_files(); }
  int type() const { return get<std::int16_t>(70); }
  /// Bytes of a voxel; 0: a type nobody knows.
  std::uint64_t bytes_per_voxel() const;
  /// The type of the numbers; none if a voxel is not one number.
  std::optional<Component> component() const;

 private:
  std::string bytes_;
  bool swapped_ = false;
};

}  // namespace blackleaf::detail
