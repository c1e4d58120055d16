#include "io/volume_header.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <sstream>
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
  std::uint64_t before = 0;  // other bytes ahead of the values, once unpacked
};

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

constexpr const char* kAgain = "get it again from its source";
constexpr const char* kMendHeader = "mend its header or get it again from its source";

// A header's word as a message can show it.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return "'" + result + "'";
}

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

// Sizes as the header tells them: at least one voxel along each dimension.
void check_sizes(const fs::path& path, const std::string& text) {
  const std::vector<std::string> sizes = words(text);
  for (const std::string& size : sizes) {
    const auto value = number<std::int64_t>(size);
    if (!value)
      refuse(path, fmt::format("its header has a size of {}, which is no whole number of voxels", shown(size)),
             kMendHeader);
    if (*value <= 0) refuse(path, fmt::format("has no voxels ({})", fmt::join(sizes, " x ")), kAgain);
  }
}

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

// A field is a key, one of the separators, and a value. Calls line(key, value, offset behind the line) until it returns
// false or the lines end.
template <class Line>
void for_each_field(const std::string& head, std::string_view separators, Line line) {
  for (std::size_t at = 0; at < head.size();) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    const std::string_view text = std::string_view(head).substr(at, end - at);
    at = end + 1;
    const auto split = text.find_first_of(separators);
    const bool more = split == std::string_view::npos
                          ? line(trimmed(text), std::string(), at)
                          : line(trimmed(text.substr(0, split)), trimmed(text.substr(split + 1)), at);
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
  std::string data_file = "LOCAL", packed_size;
  std::uint64_t header = 0;
  std::int64_t skipped = 0;
  const auto is_true = [](const std::string& value) {
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
  };
  for_each_field(head_of(path, kLongestTextHeader),
                 "=:", [&](const std::string& key, const std::string& value, std::uint64_t end) {
                   header = end;
                   if (key == "CompressedData" && is_true(value)) location.packing = Packing::compressed;
                   if ((key == "BinaryData" || key == "Binary") && !is_true(value)) location.packing = Packing::text;
                   if (key == "CompressedDataSize") packed_size = value;
                   if (key == "HeaderSize") skipped = number<std::int64_t>(value).value_or(-2);
                   if (key == "ElementDataFile") data_file = value;
                   return key != "ElementDataFile";
                 });
  const bool local = data_file == "LOCAL" || data_file == "Local" || data_file == "local";
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos) {
    location.known = false;
    return location;
  }
  if (local) {
    place_behind(location, path, header);
  } else {
    place_in(location, path, beside(path, data_file));
  }
  if (skipped < -1 || (skipped == -1 && location.packing == Packing::compressed))
    refuse(path, "its HeaderSize makes no sense", kMendHeader);
  if (skipped > 0) {
    // Counted from the file's begin, whichever file that is.
    const std::uint64_t size = location.offset + location.available;
    location.offset = std::min(size, static_cast<std::uint64_t>(skipped));
    location.available = size - location.offset;
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
  return location;
}

// A NIfTI or Analyze header is 348 bytes in either byte order.
class NiftiHeader {
 public:
  static constexpr unsigned kBytes = 348;
  NiftiHeader(const fs::path& path, std::string bytes) : bytes_(std::move(bytes)) {
    if (bytes_.size() < kBytes) refuse(path, "is too short for a NIfTI file", kAgain);
    constexpr std::int32_t kSecond = 540;
    const bool second = get<std::int32_t>(0) == kSecond;
    swapped_ = get<std::int32_t>(0) != kOrdinary;
    if (second || get<std::int32_t>(0) == kSecond) refuse(path, "is a NIfTI-2 file", "convert it to NIfTI-1 or .nrrd");
    if (get<std::int32_t>(0) != kOrdinary)
      refuse(path, "is not a NIfTI file", "its contents are not what its name says; check where it comes from");
  }

  template <class T>
  T get(std::size_t at) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), bytes_.data() + at, sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  int dimension(std::size_t i) const { return get<std::int16_t>(40 + 2 * i); }
  double spacing(std::size_t i) const { return get<float>(76 + 4 * i); }
  double data_offset() const { return get<float>(108); }
  bool one_file() const { return bytes_.compare(344, 3, "n+1") == 0; }
  bool two_files() const { return bytes_.compare(344, 3, "ni1") == 0; }
  // Bytes of a voxel; 0: a type nobody knows.
  std::uint64_t bytes_per_voxel() const {
    switch (get<std::int16_t>(70)) {
      case 2:
      case 256:
        return 1;
      case 4:
      case 512:
        return 2;
      case 128:
        return 3;
      case 8:
      case 16:
      case 768:
      case 2304:
        return 4;
      case 32:
      case 64:
      case 1024:
      case 1280:
        return 8;
      case 1536:
      case 1792:
        return 16;
      case 2048:
        return 32;
      default:
        return 0;
    }
  }

 private:
  static constexpr std::int32_t kOrdinary = kBytes;
  std::string bytes_;
  bool swapped_ = false;
};

struct NiftiFiles {
  fs::path header, data;
  bool compressed = false;
};

// The header is .nii itself, or .hdr beside .img or .img.gz.
NiftiFiles nifti_files(const fs::path& path) {
  const std::string suffix = image_suffix(path);
  if (suffix == ".nii" || suffix == ".nii.gz") return {path, path, suffix == ".nii.gz"};
  NiftiFiles files;
  fs::path base = path;
  if (suffix == ".img.gz") base.replace_extension();
  files.header = base.replace_extension(".hdr");
  files.data = base.replace_extension(".img");
  if (std::error_code error; !fs::exists(files.data, error) && fs::exists(files.data.string() + ".gz", error)) {
    files.data += ".gz";
    files.compressed = true;
  }
  return files;
}

NiftiHeader nifti_header(const NiftiFiles& files) {
  return {files.header, files.header == files.data && files.compressed
                            ? unpacked_head_of(files.header, NiftiHeader::kBytes)
                            : head_of(files.header, NiftiHeader::kBytes)};
}

// Sets also the raw bytes of a voxel.
Location nifti_location(const fs::path& path, std::uint64_t& bytes_per_voxel) {
  const NiftiFiles files = nifti_files(path);
  const NiftiHeader header = nifti_header(files);
  bytes_per_voxel = header.bytes_per_voxel();
  Location location;
  if (files.compressed) location.packing = Packing::compressed;
  if (files.header == files.data)
    place_behind(location, path, 0);
  else
    place_in(location, path, files.data);
  const double offset = header.data_offset();
  const bool bare = files.header != files.data && !header.two_files();  // Analyze: the field has no such meaning
  const bool sound = offset >= (header.one_file() ? 352 : 0) && offset < 0x1p31 && offset == std::floor(offset);
  if (!bare && (!sound || (!files.compressed && offset > static_cast<double>(location.available))))
    refuse(path,
           fmt::format("its header puts the voxels at byte {} (vox_offset) of the file, where they cannot be", offset),
           kMendHeader);
  if (sound) {
    const auto bytes = static_cast<std::uint64_t>(offset);
    if (files.compressed) {
      location.before = bytes;
    } else {
      location.offset = std::min(location.available, bytes);
      location.available -= location.offset;
    }
  }
  return location;
}

void check_nifti_header(const fs::path& path) {
  const NiftiFiles files = nifti_files(path);
  const NiftiHeader header = nifti_header(files);
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
    refuse(path, fmt::format("has values of an unknown type (datatype {})", header.get<std::int16_t>(70)),
           "convert it to numbers first");
  for (std::size_t i = 1; i <= shaped; ++i)
    if (!std::isfinite(header.spacing(i)) || header.spacing(i) == 0)
      refuse(path, fmt::format("its voxels have a size of {} along dimension {} (pixdim)", header.spacing(i), i),
             kMendHeader);
  finite(80, shaped, "voxel size (pixdim)");
  if (header.one_file() || header.two_files()) {
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
  std::uint64_t ignored = 0;
  nifti_location(path, ignored);
}

void check_meta_header(const fs::path& path) {
  constexpr std::array kTypes{"MET_CHAR", "MET_UCHAR", "MET_SHORT", "MET_USHORT", "MET_INT",       "MET_UINT",
                              "MET_LONG", "MET_ULONG", "MET_FLOAT", "MET_DOUBLE", "MET_LONG_LONG", "MET_ULONG_LONG"};
  bool found = false;
  const auto check = [&](const std::string& key, const std::string& value, std::uint64_t) {
    if (key == "NDims") {
      found = true;
      const auto dimensions = number<int>(value);
      if (!dimensions || *dimensions < 1 || *dimensions > 10)
        refuse(path, fmt::format("its header tells of {} dimensions (NDims); a solid has 3", shown(value)),
               kMendHeader);
    }
    if (key == "DimSize") check_sizes(path, value);
    if (key == "ElementType" && !value.ends_with("_ARRAY") &&
        std::find(kTypes.begin(), kTypes.end(), value) == kTypes.end())
      refuse(path, fmt::format("has values of an unknown type ({})", shown(value)), "convert it to numbers first");
    for (const char* name : {"ElementSpacing", "ElementSize", "Offset", "Position", "Origin", "TransformMatrix",
                             "Rotation", "Orientation"})
      if (key == name)
        for (const std::string& word : words(value)) {
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
  meta_location(path);
}

void check_nrrd_header(const fs::path& path) {
  const auto check = [&](std::string key, std::string value, std::uint64_t) {
    const auto lower = [](std::string& text) {
      for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    };
    lower(key);
    lower(value);
    if (key == "sizes") check_sizes(path, value);
    if (key == "space directions" || key == "space origin")
      if (value.find("nan") != std::string::npos || value.find("inf") != std::string::npos)
        refuse(path, fmt::format("its {} has numbers that are not finite", key), kMendHeader);
    return !key.empty();
  };
  const std::string head = head_of(path, kLongestTextHeader);
  if (!head.starts_with("NRRD"))
    refuse(path, "is not a NRRD file", "its contents are not what its name says; check where it comes from");
  for_each_field(head, ":", check);
  nrrd_location(path);
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

void check_header(const fs::path& path, ImageFormat format) {
  switch (format) {
    case ImageFormat::nrrd:
      return check_nrrd_header(path);
    case ImageFormat::nifti:
      return check_nifti_header(path);
    case ImageFormat::meta:
      return check_meta_header(path);
  }
}

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
  if (location.packing == Packing::compressed && !inflates_to(location, location.before + voxels * stored))
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: its compressed values are damaged or fewer than its header tells", path.string()),
                "get it again from its source");
}

}  // namespace blackleaf::detail
