#include "io/volume_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/header_text.h"
#include "io/nifti_header.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

// Sizes as the header tells them: at least one voxel along each dimension.
void check_sizes(const fs::path& path, const std::string& text) {
  const std::vector<std::string_view> sizes = words(text);
  for (const std::string_view size : sizes) {
    const auto value = number<std::int64_t>(size);
    if (!value)
      refuse(path, fmt::format("its header has a size of {}, which is no whole number of voxels", shown(size)),
             kMendHeader);
    if (*value <= 0) refuse(path, fmt::format("has no voxels ({})", fmt::join(sizes, " x ")), kAgain);
  }
}

void check_nifti_header(const fs::path& path) {
  const NiftiFiles files = nifti_files(path);
  const NiftiHeader header(files);
  const auto finite = [&](std::size_t at, std::size_t count, const char* what) {
    for (std::size_t i = 0; i < count; ++i)
      // Squares and products of larger numbers are beyond the library's floats.
      if (!(std::abs(header.get<float>(at + 4 * i)) < 1e12F))
        refuse(path, fmt::format("its {} has numbers that are not finite or beyond all bounds", what), kMendHeader);
  };
  if (files.header == files.data ? !header.one_file() : header.one_file())
    refuse(path, "its header is not of a NIfTI file of this suffix",
           ".nii holds header and voxels, .hdr a header with its voxels in .img; check where it comes from");
  const int dimensions = header.dimension(0);
  if (dimensions < 1 || dimensions > 7)
    refuse(path, fmt::format("its header tells of {} dimensions; NIfTI has 1 to 7", dimensions), kAgain);
  const auto shaped = static_cast<std::size_t>(std::min(dimensions, 3));
  std::vector<int> size;
  for (std::size_t i = 1; i <= shaped; ++i) size.push_back(header.dimension(i));
  if (*std::min_element(size.begin(), size.end()) <= 0)
    refuse(path, fmt::format("has no voxels ({})", fmt::join(size, " x ")), kAgain);
  if (header.bytes_per_voxel() == 0)
    refuse(path, fmt::format("has values of an unknown type (datatype {})", header.type()),
           "convert it to numbers first");
  for (std::size_t i = 1; i <= shaped; ++i)
    if (!std::isfinite(header.spacing(i)) || header.spacing(i) == 0)
      refuse(path, fmt::format("its voxels have a size of {} along dimension {} (pixdim)", header.spacing(i), i),
             kMendHeader);
  finite(80, shaped, "voxel size (pixdim)");
  if (header.is_nifti()) {
    if (header.get<std::int16_t>(252) > 0) {
      finite(76, 1, "qform");
      finite(256, 6, "qform");
    }
    if (header.get<std::int16_t>(254) > 0) {
      finite(280, 12, "sform");
      for (std::size_t i = 0; i < shaped; ++i)
        if (const auto part = [&](std::size_t row) { return header.get<float>(280 + 16 * row + 4 * i); };
            part(0) == 0 && part(1) == 0 && part(2) == 0 && header.get<std::int16_t>(252) <= 0)
          refuse(path, "its axes do not span space: one of them has no length (sform)", kMendHeader);
    }
  }
}

void check_meta_header(const fs::path& path) {
  constexpr std::array kTypes{"MET_CHAR", "MET_UCHAR", "MET_SHORT", "MET_USHORT", "MET_INT",       "MET_UINT",
                              "MET_LONG", "MET_ULONG", "MET_FLOAT", "MET_DOUBLE", "MET_LONG_LONG", "MET_ULONG_LONG"};
  bool found = false;
  int told = 0;
  std::size_t sizes = 0;
  const auto check = [&](const std::string& key, const std::string& value, std::uint64_t) {
    if (key == "NDims") {
      found = true;
      const auto dimensions = number<int>(value);
      if (!dimensions || *dimensions < 1 || *dimensions > 10)
        refuse(path, fmt::format("its header tells of {} dimensions (NDims); a solid has 3", shown(value)),
               kMendHeader);
      told = *dimensions;
    }
    if (key == "DimSize") {
      check_sizes(path, value);
      sizes = words(value).size();
    }
    if (key == "ElementType" && !value.ends_with("_ARRAY") &&
        std::find(kTypes.begin(), kTypes.end(), value) == kTypes.end())
      refuse(path, fmt::format("has values of an unknown type ({})", shown(value)), "convert it to numbers first");
    for (const char* name : {"ElementSpacing", "ElementSize", "Offset", "Position", "Origin", "TransformMatrix",
                             "Rotation", "Orientation"})
      if (key == name)
        for (const std::string_view word : words(value)) {
          const auto x = number<double>(word);
          if (!x || !std::isfinite(*x))
            refuse(path, fmt::format("its {} has {} for a number", name, shown(word)), kMendHeader);
          if (key == "ElementSpacing" && *x == 0)
            refuse(path, "its axes do not span space: a voxel has no size along one of them", kMendHeader);
        }
    return key != "ElementDataFile";
  };
  for_each_field(head_of(path, kLongestTextHeader), "=:", check);
  if (!found)
    refuse(path, "is not a MetaImage file", "its contents are not what its name says; check where it comes from");
  if (sizes != static_cast<std::size_t>(told))
    refuse(path, fmt::format("its header tells of {} dimensions (NDims), but has {} sizes (DimSize)", told, sizes),
           kMendHeader);
}

void check_nrrd_header(const fs::path& path) {
  const auto check = [&](const std::string& name, const std::string& text, std::uint64_t) {
    if (text.starts_with('=')) return true;  // key:=value pairs mean nothing to us
    const std::string key = lower(name), value = lower(text);
    if (key == "sizes") check_sizes(path, value);
    if (key == "space directions" || key == "space origin")
      if (value.find("nan") != std::string::npos || value.find("inf") != std::string::npos)
        refuse(path, fmt::format("its {} has numbers that are not finite", key), kMendHeader);
    if (key == "spacings")
      for (const std::string_view word : words(value))
        if (const auto x = number<double>(word); !x || !std::isfinite(*x) || *x <= 0)
          refuse(path, fmt::format("its spacings have {}, which is no side of a voxel", shown(word)), kMendHeader);
    if (key == "encoding" && (value == "bzip2" || value == "bz2"))
      refuse(path, "its values are packed with bzip2", "save it raw or with gzip");
    return !key.empty();
  };
  const std::string head = head_of(path, kLongestTextHeader);
  if (!head.starts_with("NRRD"))
    refuse(path, "is not a NRRD file", "its contents are not what its name says; check where it comes from");
  for_each_field(head, ":", check);
}

}  // namespace

ValueLocation check_header(const fs::path& path, ImageFormat format) {
  switch (format) {
    case ImageFormat::nrrd:
      check_nrrd_header(path);
      break;
    case ImageFormat::nifti:
      check_nifti_header(path);
      break;
    case ImageFormat::meta:
      check_meta_header(path);
      break;
  }
  return locate_values(path, format);
}

void check_believable(const fs::path& path, const ValueLocation& location, std::uint64_t voxels, std::uint64_t bytes) {
  if (!location.known) return;
  // deflate packs 1032 bytes into one at the very best; a number written as text takes a digit and a blank.
  const std::uint64_t needed = location.packing == Packing::raw          ? bytes
                               : location.packing == Packing::text       ? 2 * voxels - 1
                               : location.packing == Packing::hex        ? 2 * bytes
                               : location.packing == Packing::compressed ? bytes / 1040
                                                                         : 1;
  if (location.available < needed)
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its header tells of {} voxels, which need at least {} bytes, but there are {}",
                            path.string(), voxels, needed, location.available),
                "the file was cut off or its header is damaged; get it again from its source");
}

}  // namespace blackleaf::detail
