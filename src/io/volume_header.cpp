#include "io/volume_header.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <span>
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
  bool known = true;         // false: several data files; then nothing is claimed
  fs::path file;             // where the values are,
  std::uint64_t offset = 0;  // from here on
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

std::string unpacked_head_of(const fs::path& path, unsigned limit) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  std::string head(limit, '\0');
  const int got = file ? gzread(file.get(), head.data(), limit) : 0;
  head.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return head;
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

// The values follow the header in the same file ...
void place_behind(Location& location, const fs::path& path, std::uint64_t header) {
  const std::uint64_t size = InputFile(path).size();
  location.file = path;
  location.offset = std::min(size, header);
  location.available = size - location.offset;
}

// ... or are in a file of their own.
void place_in(Location& location, const fs::path& header, const fs::path& file) {
  location.file = file;
  try {
    location.available = InputFile(file).size();
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its data file cannot be read: {}", header.string(), error.what()));
  }
}

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
    place_in(location, path, beside(path, data_file));
  } else {
    place_behind(location, path, header);
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
    place_behind(location, path, header);
  } else {
    place_in(location, path, beside(path, data_file));
  }
  return location;
}

// NIfTI and Analyze: the header is .nii itself, or .hdr beside .img or .img.gz. Sets also the raw bytes of a voxel.
Location nifti_location(const fs::path& path, std::uint64_t& bytes_per_voxel) {
  Location location;
  const std::string suffix = image_suffix(path);
  fs::path header = path, data = path;
  if (suffix == ".nii.gz") {
    location.packing = Packing::compressed;
  } else if (suffix != ".nii") {
    fs::path base = path;
    if (suffix == ".img.gz") base.replace_extension();
    header = base.replace_extension(".hdr");
    data = base.replace_extension(".img");
    if (std::error_code error; !fs::exists(data, error) && fs::exists(data.string() + ".gz", error)) {
      data += ".gz";
      location.packing = Packing::compressed;
    }
  }
  const std::string head = suffix == ".nii.gz" ? unpacked_head_of(path, 348) : head_of(header, 348);
  double offset = 0;
  if (head.size() == 348) {
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
    offset = get(float{}, 108);
  }
  if (header == data) {
    const bool packed = location.packing == Packing::compressed;
    place_behind(location, path, !packed && offset > 0 && offset < 1e9 ? static_cast<std::uint64_t>(offset) : 0);
  } else
    place_in(location, path, data);
  return location;
}

// Unpacks gzip or zlib data and throws the result away: false unless they are whole, their checksums right, and at
// least `needed` bytes long. ITK's readers notice little of this (MetaIO takes whatever comes out of half a stream).
bool inflates_to(const Location& location, std::uint64_t needed) {
  const InputFile file(location.file);
  z_stream stream{};
  constexpr int kGzipOrZlib = 15 + 32;
  if (inflateInit2(&stream, kGzipOrZlib) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, inflateEnd);
  std::vector<std::uint8_t> in(std::size_t{1} << 16), out(std::size_t{1} << 18);
  std::uint64_t at = location.offset;
  std::uint64_t produced = 0;
  const std::uint64_t end = location.offset + location.available;
  int status = Z_OK;
  for (;;) {
    if (stream.avail_in == 0 && at < end) {
      const std::span part =
          std::span(in).first(static_cast<std::size_t>(std::min<std::uint64_t>(in.size(), end - at)));
      file.read_at(at, part);
      at += part.size();
      stream.next_in = part.data();
      stream.avail_in = static_cast<unsigned>(part.size());
    }
    if (status == Z_STREAM_END) {
      // Files may hold several gzip members, one behind the other; anything else at the end is of no concern.
      if (produced >= needed || stream.avail_in == 0) return produced >= needed;
      if (inflateReset(&stream) != Z_OK) return false;
    }
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(out.size());
    status = inflate(&stream, Z_NO_FLUSH);
    produced += out.size() - stream.avail_out;
    if (status != Z_OK && status != Z_STREAM_END) return false;  // damaged, or at its end too early
  }
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
                               : location.packing == Packing::compressed ? voxels * stored / 1040
                                                                         : 1;
  if (location.available < needed)
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its header tells of {} voxels, which need at least {} bytes, but there are {}",
                            path.string(), voxels, needed, location.available),
                "the file was cut off or its header is damaged; get it again from its source");
  if (location.packing == Packing::compressed && !inflates_to(location, voxels * stored))
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its compressed values are damaged or fewer than its header tells", path.string()),
                "get it again from its source");
}

}  // namespace blackleaf::detail
