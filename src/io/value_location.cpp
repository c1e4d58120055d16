#include "io/value_location.h"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/header_text.h"
#include "io/nifti_header.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

constexpr bool kLittle = std::endian::native == std::endian::little;

// The values follow the header in the same file ...
void place_behind(ValueLocation& location, const fs::path& path, std::uint64_t header) {
  const std::uint64_t size = InputFile(path).size();
  location.file = path;
  location.offset = std::min(size, header);
  location.available = size - location.offset;
}

// ... or are in a file of their own.
void place_in(ValueLocation& location, const fs::path& header, const fs::path& file) {
  location.file = file;
  // Before it is opened: a pipe without a writer would never open.
  if (std::error_code error;
      fs::exists(file, error) && !fs::is_directory(file, error) && !fs::is_regular_file(file, error))
    refuse(header, "its data file is not an ordinary file", "name one in its header");
  try {
    location.available = InputFile(file).size();
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its data file cannot be read: {}", header.string(), error.what()));
  }
}

void skip(ValueLocation& location, std::uint64_t bytes) {
  bytes = std::min(bytes, location.available);
  location.offset += bytes;
  location.available -= bytes;
}

fs::path beside(const fs::path& header, const std::string& name) {
  return fs::path(name).is_absolute() ? fs::path(name) : header.parent_path() / name;
}

ValueLocation nrrd_location(const fs::path& path) {
  ValueLocation location;
  std::string data_file;
  std::uint64_t header = 0;
  std::int64_t lines = 0, bytes = 0;
  for_each_field(head_of(path, kLongestTextHeader), ":",
                 [&](const std::string& name, const std::string& value, std::uint64_t end) {
                   header = end;
                   if (value.starts_with('=')) return true;  // key:=value pairs mean nothing to us
                   const std::string key = lower(name);
                   if (key == "encoding") {
                     const std::string encoding = lower(value);
                     location.packing = encoding == "raw"                          ? Packing::raw
                                        : encoding == "gzip" || encoding == "gz"   ? Packing::compressed
                                        : encoding == "bzip2" || encoding == "bz2" ? Packing::other
                                        : encoding == "hex"                        ? Packing::hex
                                                                                   : Packing::text;
                   }
                   if (key == "endian") location.swapped = (lower(value) == "little") != kLittle;
                   if (key == "line skip" || key == "lineskip") lines = number<std::int64_t>(value).value_or(-1);
                   if (key == "byte skip" || key == "byteskip") bytes = number<std::int64_t>(value).value_or(-2);
                   if (key == "data file" || key == "datafile") data_file = value;
                   return !key.empty();
                 });
  if (data_file.find(' ') != std::string::npos || data_file.find('%') != std::string::npos ||
      data_file.starts_with("LIST")) {
    location.known = location.direct = false;
    return location;
  }
  if (!data_file.empty())
    place_in(location, path, beside(path, data_file));
  else
    place_behind(location, path, header);
  if (lines != 0 || bytes < -1 || (bytes != 0 && location.packing != Packing::raw)) location.direct = false;
  if (location.packing == Packing::raw && bytes > 0) skip(location, static_cast<std::uint64_t>(bytes));
  location.at_end = bytes == -1;
  if (location.packing != Packing::raw && location.packing != Packing::compressed) location.direct = false;
  return location;
}

ValueLocation meta_location(const fs::path& path) {
  ValueLocation location;
  std::string data_file = "LOCAL", packed_size;
  std::uint64_t header = 0;
  std::int64_t skipped = 0;
  bool most_significant_first = false;
  const auto is_true = [](const std::string& value) {
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
  };
  for_each_field(head_of(path, kLongestTextHeader),
                 "=:", [&](const std::string& key, const std::string& value, std::uint64_t end) {
                   header = end;
                   if (key == "CompressedData" && is_true(value)) location.packing = Packing::compressed;
                   if ((key == "BinaryData" || key == "Binary") && !is_true(value)) location.packing = Packing::text;
                   if (key == "BinaryDataByteOrderMSB" || key == "ElementByteOrderMSB")
                     most_significant_first = is_true(value);
                   if (key == "CompressedDataSize") packed_size = value;
                   if (key == "HeaderSize") skipped = number<std::int64_t>(value).value_or(-2);
                   if (key == "ElementDataFile") data_file = value;
                   return key != "ElementDataFile";
                 });
  const bool local = data_file == "LOCAL" || data_file == "Local" || data_file == "local";
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos) {
    location.known = location.direct = false;
    return location;
  }
  location.swapped = most_significant_first == kLittle;
  if (local) {
    place_behind(location, path, header);
  } else {
    place_in(location, path, beside(path, data_file));
  }
  if (skipped < -1 || (skipped == -1 && location.packing == Packing::compressed))
    refuse(path, "its HeaderSize makes no sense", kMendHeader);
  location.at_end = skipped == -1;
  if (skipped > 0) {
    // Counted from the file's begin, whichever file that is.
    location.available += location.offset;
    location.offset = 0;
    skip(location, static_cast<std::uint64_t>(skipped));
  }
  if (location.packing == Packing::compressed) {
    // MetaIO believes the length that the header tells; without it, it takes values behind a header from nowhere.
    const std::int64_t length = packed_size.empty() ? 0 : number<std::int64_t>(packed_size).value_or(-1);
    if (length == 0 && local)
      refuse(path, "its values are compressed but its header has no CompressedDataSize", kMendHeader);
    if (length < 0 || static_cast<std::uint64_t>(length) > location.available)
      refuse(path,
             fmt::format("its header tells of {} bytes of compressed values, but there are {}", shown(packed_size),
                         location.available),
             kMendHeader);
    if (length > 0) location.available = static_cast<std::uint64_t>(length);
  }
  if (location.packing == Packing::text) location.direct = false;
  return location;
}

ValueLocation nifti_location(const fs::path& path) {
  const NiftiFiles files = nifti_files(path);
  const NiftiHeader header(files);
  ValueLocation location;
  if (files.compressed) location.packing = Packing::compressed;
  if (files.header == files.data)
    place_behind(location, path, 0);
  else
    place_in(location, path, files.data);
  const double offset = header.data_offset();
  const bool bare = !header.is_nifti();
  const bool sound = offset >= (header.one_file() ? 352 : 0) && offset < 0x1p31 && offset == std::floor(offset);
  if (!bare && (!sound || (!files.compressed && offset > static_cast<double>(location.available))))
    refuse(path,
           fmt::format("its header puts the voxels at byte {} (vox_offset) of the file, where they cannot be", offset),
           kMendHeader);
  if (sound) {
    const auto bytes = static_cast<std::uint64_t>(offset);
    if (files.compressed)
      location.before = bytes;
    else
      skip(location, bytes);
  }
  location.swapped = header.swapped();
  location.stored = header.component();
  if (!bare) {
    // As ITK has it: what is no number counts as 0, and a slope of 0 as 1.
    const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
    constexpr double kNothing = std::numeric_limits<double>::epsilon();
    location.slope = std::abs(finite(header.slope())) < kNothing ? 1 : header.slope();
    location.intercept = finite(header.intercept());
    if (std::abs(location.slope - 1) <= kNothing && std::abs(location.intercept) <= kNothing) {
      location.slope = 1;
      location.intercept = 0;
    }
  }
  return location;
}

}  // namespace

ValueLocation locate_values(const fs::path& path, ImageFormat format) {
  switch (format) {
    case ImageFormat::nrrd:
      return nrrd_location(path);
    case ImageFormat::nifti:
      return nifti_location(path);
    case ImageFormat::meta:
      return meta_location(path);
  }
  return {};
}

}  // namespace blackleaf::detail
