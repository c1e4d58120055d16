#include "io/volume_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

enum class Packing { raw, text, hex, compressed, unlimited };

// Where the values are and how they are packed, as far as the header tells it simply.
struct Location {
  std::uint64_t available = 0;  // bytes that can hold values
  Packing packing = Packing::raw;
  bool known = true;  // false: several data files, or skips; then nothing is claimed
};

std::string head_of(const fs::path& path, std::size_t limit) {
  InputFile file(path);
  std::vector<std::uint8_t> bytes(limit);
  std::size_t size = 0;
  while (size < limit) {
    const std::size_t got = file.read_some(std::span(bytes).subspan(size));
    if (got == 0) break;
    size += got;
  }
  return {reinterpret_cast<const char*>(bytes.data()), size};
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

// Calls line(key, value, offset behind the line) until it returns false or the lines end.
template <class Line>
void for_each_field(const std::string& head, std::string_view separator, Line line) {
  for (std::size_t at = 0; at < head.size();) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view text = std::string_view(head).substr(at, end - at);
    at = end + 1;
    const auto split = text.find(separator);
    const bool more = split == std::string_view::npos
                          ? line(trimmed(text), std::string(), at)
                          : line(trimmed(text.substr(0, split)), trimmed(text.substr(split + separator.size())), at);
    if (!more) return;
  }
}

std::uint64_t size_of(const fs::path& path) { return InputFile(path).size(); }

fs::path beside(const fs::path& header, const std::string& name) {
  return fs::path(name).is_absolute() ? fs::path(name) : header.parent_path() / name;
}

constexpr std::size_t kLongestTextHeader = std::size_t{1} << 20;

Location nrrd_location(const fs::path& path) {
  Location location;
  std::string data_file;
  std::uint64_t header = 0;
  for_each_field(head_of(path, kLongestTextHeader), ":",
                 [&](const std::string& key, const std::string& value, std::uint64_t end) {
                   header = end;
                   if (key == "encoding") {
                     location.packing = value == "raw"                       ? Packing::raw
                                        : value == "gzip" || value == "gz"   ? Packing::compressed
                                        : value == "bzip2" || value == "bz2" ? Packing::unlimited
                                        : value == "hex"                     ? Packing::hex
                                                                             : Packing::text;
                   }
                   if (key == "data file" || key == "datafile") data_file = value;
                   return !key.empty();
                 });
  if (data_file.find(' ') != std::string::npos || data_file.starts_with("LIST")) {
    location.known = false;
  } else if (!data_file.empty()) {
    location.available = size_of(beside(path, data_file));
  } else {
    const std::uint64_t size = size_of(path);
    location.available = size - std::min(size, header);
  }
  return location;
}

Location meta_location(const fs::path& path) {
  Location location;
  std::string data_file = "LOCAL";
  std::uint64_t header = 0;
  const auto is_true = [](const std::string& value) {
    return value == "True" || value == "true" || value == "1" || value == "TRUE";
  };
  for_each_field(head_of(path, kLongestTextHeader), "=",
                 [&](const std::string& key, const std::string& value, std::uint64_t end) {
                   header = end;
                   if (key == "CompressedData" && is_true(value)) location.packing = Packing::compressed;
                   if ((key == "BinaryData" || key == "Binary") && !is_true(value)) location.packing = Packing::text;
                   if (key == "ElementDataFile") data_file = value;
                   return key != "ElementDataFile";
                 });
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos) {
    location.known = false;
  } else if (data_file == "LOCAL" || data_file == "Local" || data_file == "local") {
    const std::uint64_t size = size_of(path);
    location.available = size - std::min(size, header);
  } else {
    location.available = size_of(beside(path, data_file));
  }
  return location;
}

// NIfTI and Analyze: the header is .nii itself, or .hdr beside .img or .img.gz. Returns also the raw bytes of a voxel.
Location nifti_location(const fs::path& path, std::uint64_t& bytes_per_voxel) {
  Location location;
  const std::string suffix = image_suffix(path);
  if (suffix == ".nii.gz") {
    location.packing = Packing::compressed;
    location.available = size_of(path);
    return location;
  }
  fs::path header = path, data = path;
  if (suffix != ".nii") {
    fs::path base = path;
    if (suffix == ".img.gz") base.replace_extension();
    header = base.replace_extension(".hdr");
    data = base.replace_extension(".img");
    if (std::error_code error; !fs::exists(data, error) && fs::exists(data.string() + ".gz", error)) {
      data += ".gz";
      location.packing = Packing::compressed;
    }
  }
  const std::string head = head_of(header, 348);
  if (head.size() == 348 && location.packing == Packing::raw) {
    const auto get = [&]<class T>(T value, std::size_t at) {
      std::array<char, sizeof(T)> bytes;
      std::memcpy(bytes.data(), head.data() + at, sizeof(T));
      std::int32_t header_size = 0;
      std::memcpy(&header_size, head.data(), sizeof header_size);
      if (header_size != 348) std::reverse(bytes.begin(), bytes.end());
      std::memcpy(&value, bytes.data(), sizeof(T));
      return value;
    };
    const auto bits = get(std::int16_t{}, 72);
    if (bits > 0) bytes_per_voxel = static_cast<std::uint64_t>(bits) / 8;
    const auto offset = get(float{}, 108);
    location.available = size_of(data);
    if (header == data && offset > 0 && offset < 1e9f)
      location.available -= std::min(location.available, static_cast<std::uint64_t>(offset));
  } else {
    location.available = size_of(data);
  }
  return location;
}

}  // namespace

void check_believable(const fs::path& path, ImageFormat format, std::uint64_t voxels, std::uint64_t bytes) {
  std::uint64_t stored = voxels > 0 ? bytes / voxels : 0;  // bytes of a voxel in the file
  const Location location = format == ImageFormat::nrrd   ? nrrd_location(path)
                            : format == ImageFormat::meta ? meta_location(path)
                                                          : nifti_location(path, stored);
  if (!location.known) return;
  // deflate packs 1032 bytes into one at the very best; a number written as text takes a digit and a blank.
  const std::uint64_t needed = location.packing == Packing::raw          ? voxels * stored
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
