// Gray pictures as slices: PNG files through libpng and TIFF pages through libtiff.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/image_io.h"

namespace blackleaf::detail {

/// One picture, as its header tells.
struct Picture {
  std::int64_t width = 0, height = 0;
  Component component = Component::u8;  // of its values; 1, 2 and 4 bits become bytes

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// Reads the header of a PNG file. Throws Error(bad_input) for damaged ones and for pictures with colours, a palette or
/// an alpha channel.
Picture png_header(const std::filesystem::path& path);
/// Decodes it: its numbers as they are stored, whatever gamma it tells. To be used in a process of its own. Requires:
/// room for the values. Throws Error(bad_input).
void decode_png(const std::filesystem::path& path, const Picture& picture, void* values);

/// A TIFF file: its pages, and voxel sizes where its description tells them.
struct TiffFile {
  std::vector<Picture> pages;              // reduced copies and masks are left out
  std::vector<std::uint32_t> directories;  // of each page
  /// Sides of a voxel in mm, if ImageJ's or OME's description tells all three.
  std::optional<std::array<double, 3>> spacing;
};

/// Reads the headers of TIFF files in a process of its own. Throws Error(bad_input) for damaged ones and for pages with
/// colours, several numbers a pixel, or types that are no component.
std::vector<TiffFile> read_tiff_headers(const std::vector<std::filesystem::path>& files);

/// Decodes pages, fastest in the order in which they lie in the file. To be used in a process of its own.
class TiffDecoder {
 public:
  TiffDecoder();
  ~TiffDecoder();
  TiffDecoder(const TiffDecoder&) = delete;
  TiffDecoder& operator=(const TiffDecoder&) = delete;

  /// Requires: room for the values; `page` and `directory` are from the file's headers. Throws Error(bad_input).
  void decode(const std::filesystem::path& path, const Picture& page, std::uint32_t directory, void* values);

 private:
  struct Tiff;
  std::unique_ptr<Tiff> tiff_;
};

/// Sides of a voxel in mm as ImageJ's or OME's text in a TIFF file tells them, with the picture's resolution (pixels a
/// unit along x and y; 0: unknown). None unless all three are told in units of length. Throws Error(bad_input), which
/// begins with `name`, when the text tells of several channels or times, or of other than `pages` pictures.
std::optional<std::array<double, 3>> spacing_of_description(const std::string& name, const std::string& text,
                                                            std::array<double, 2> resolution, std::size_t pages);

}  // namespace blackleaf::detail
