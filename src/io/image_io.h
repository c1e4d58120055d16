// Volumes in and out through ITK. Only image_io.cpp sees ITK's headers; they bring an Eigen of their own, so this
// header and that file do without Eigen.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blackleaf::detail {

enum class ImageFormat { nrrd, nifti, meta };
/// "NRRD" and so on, for messages.
const char* format_name(ImageFormat format);
/// The format that a file's suffix stands for, in any case of letters.
std::optional<ImageFormat> image_format(const std::filesystem::path& path);
/// The suffix in small letters, ".nii.gz" and ".img.gz" in one piece; empty if there is none.
std::string image_suffix(const std::filesystem::path& path);

enum class Component { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
std::size_t bytes_of(Component component);
/// What function(T{}) returns, T being the component's type: the one switch over the types of values.
template <class Function>
auto with_type_of(Component component, Function&& function) {
  switch (component) {
    case Component::u8:
      return function(std::uint8_t{});
    case Component::i8:
      return function(std::int8_t{});
    case Component::u16:
      return function(std::uint16_t{});
    case Component::i16:
      return function(std::int16_t{});
    case Component::u32:
      return function(std::uint32_t{});
    case Component::i32:
      return function(std::int32_t{});
    case Component::u64:
      return function(std::uint64_t{});
    case Component::i64:
      return function(std::int64_t{});
    case Component::f32:
      return function(float{});
    case Component::f64:
      break;
  }
  return function(double{});
}

/// World = origin + sum of p[i] axes[i], where p counts voxels from the *centre* of the first one.
struct ImageGeometry {
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::string unit = "mm";
};

/// What a volume's header says.
struct ImageInformation {
  std::vector<std::int64_t> size;      // of every dimension the file has
  int components = 1;                  // numbers a voxel
  std::optional<Component> component;  // none: not a number
  ImageGeometry geometry;
};

/// Reads one volume file. Errors are one line, Error(bad_input).
class ImageReader {
 public:
  ImageReader(const std::filesystem::path& path, ImageFormat format);
  ~ImageReader();
  ImageReader(const ImageReader&) = delete;
  ImageReader& operator=(const ImageReader&) = delete;

  const ImageInformation& information() const { return information_; }
  /// All values, the first dimension fastest. Requires: room for all of them, set to zero: some
  /// damage leaves values unread without an error.
  void read(void* values);

 private:
  struct Itk;
  void take_information();
  std::unique_ptr<Itk> itk_;
  ImageInformation information_;
};

/// Writes a three-dimensional volume of uint8, uint16 or uint32. `path` must have one of the format's suffixes. Throws
/// Error(io).
void write_image(const std::filesystem::path& path, ImageFormat format, const std::array<std::int64_t, 3>& size,
                 const ImageGeometry& geometry, Component component, const void* values);

}  // namespace blackleaf::detail
