// DICOM files through GDCM: what their headers say, and their values. Only dicom_files.cpp sees GDCM.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/image_io.h"

namespace blackleaf::detail {

/// Where one frame of a file lies, in mm and LPS, and what its stored numbers mean: slope * stored + intercept.
struct DicomFrame {
  bool has_place = false;                      // the four below are known
  std::array<double, 3> position{};            // of the centre of its first pixel
  std::array<double, 3> along_x{}, along_y{};  // directions of increasing column and row
  std::array<double, 2> spacing{};             // between columns, between rows
  double thickness = 0;                        // distance of slices that the header tells; 0: none
  double slope = 1, intercept = 0;
};

/// How the stored numbers of a file are packed.
struct DicomPixels {
  std::int64_t columns = 0, rows = 0, frames = 0;
  int samples = 1;         // numbers a pixel
  int bits_allocated = 0;  // 8, 16 or 32
  int bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  bool palette = false;
  bool encapsulated = false;  // compressed
  std::uint64_t offset = 0;   // of the first value in the file, in this machine's byte order; 0: packed in some way
};

struct DicomFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::string series, description;  // Series Instance UID, Series Description; printable
  std::int64_t number = 0;          // Instance Number; 0: none
  DicomPixels pixels;
  std::vector<DicomFrame> frames;  // empty: no image
};

/// Reads the headers of all files in a process of its own. Throws Error(bad_input) for a damaged file. O(headers).
std::vector<DicomFile> read_dicom_headers(const std::vector<std::filesystem::path>& files);

/// Decodes frames. To be used in a process of its own: damaged files can crash GDCM, keep it busy or take memory.
class DicomDecoder {
 public:
  DicomDecoder();
  ~DicomDecoder();
  DicomDecoder(const DicomDecoder&) = delete;
  DicomDecoder& operator=(const DicomDecoder&) = delete;

  /// Writes slope * stored + intercept of every pixel of a frame, row by row. Requires: the component holds all such
  /// values of this file's stored range; frame < file.frames.size(). Throws Error(bad_input).
  void decode(const DicomFile& file, std::size_t frame, Component component, void* values);

 private:
  struct Gdcm;
  std::unique_ptr<Gdcm> gdcm_;
};

}  // namespace blackleaf::detail
