#include "io/value_location.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

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

constexpr const char* kOneFile = "save it as one file";

// Bytes in one of several data files; missing ones are refused.
std::uint64_t part_size(const fs::path& header, const std::string& name) {
  ValueLocation part;
  place_in(part, header, beside(header, name));
  return part.available;
}

// "name%03d.raw": the text before the number, its width, whether zeros fill it, and the text behind. Other conversions
// are refused: the libraries hand the pattern to printf.
struct NamePattern {
  NamePattern(const fs::path& header, std::string_view text) {
    const std::size_t percent = text.find('%'), letter = text.find_first_not_of("0123456789", percent + 1);
    if (letter == std::string_view::npos || text[letter] != 'd' || letter - percent > 3 ||
        text.find('%', letter) != std::string_view::npos)
      refuse(header, fmt::format("its data files have names like {}, which is no name with one number", shown(text)),
             "write a pattern such as slice%03d.raw");
    const std::string_view digits = text.substr(percent + 1, letter - percent - 1);
    zeros = digits.starts_with('0');
    width = number<int>(digits).value_or(0);
    before = text.substr(0, percent);
    behind = text.substr(letter + 1);
  }
  std::string name(std::int64_t i) const {
    return before + (zeros ? fmt::format("{:0{}}", i, width) : fmt::format("{:{}}", i, width)) + behind;
  }
  std::string before, behind;
  int width = 0;
  bool zeros = false;
};

// The names that a pattern and its "first last step" stand for; a wrong number of them is refused.
std::vector<std::string> names_of(const fs::path& header, std::string_view pattern, std::array<std::int64_t, 3> range) {
  const NamePattern names(header, pattern);
  const auto [first, last, step] = range;
  constexpr std::int64_t kMost = 1'000'000;
  if (step == 0 || std::max(std::abs(first), std::abs(last)) > std::numeric_limits<int>::max() ||
      (last - first) / step < 0 || (last - first) / step >= kMost)
    refuse(header, "the numbers of its data files make no sense", kMendHeader);
  std::vector<std::string> result;
  for (std::int64_t i = first; step > 0 ? i <= last : i >= last; i += step) result.push_back(names.name(i));
  return result;
}

// Names in the lines from here on, without blanks behind them, up to the last that is not empty.
std::vector<std::string> listed_names(std::string_view lines) {
  std::vector<std::string> result;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    result.emplace_back(line.substr(0, line.find_last_not_of(" \t\r\v\f") + 1));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  while (!result.empty() && result.back().empty()) result.pop_back();
  return result;
}

// What a MetaImage header tells of a volume in several files.
struct MetaParts {
  std::vector<std::int64_t> size;
  std::string type;
  std::int64_t channels = 1, skipped = 0;
};

// The library leaves a slice without a file, or the end of a short one, as it finds the memory.
void check_meta_parts(const fs::path& path, const std::string& data_file, std::string_view lines,
                      const MetaParts& parts) {
  const std::vector<std::string_view> word = words(data_file);
  const std::size_t dimensions = parts.size.size();
  if (dimensions == 0 || parts.channels < 1)
    refuse(path, "its header does not tell the size of its data files", kMendHeader);
  std::size_t inside = dimensions - 1;  // dimensions within one file
  std::vector<std::string> names;
  if (data_file.starts_with("LIST")) {
    if (word.size() > 1) {
      std::string_view told = word[1];
      if (told.ends_with('D') || told.ends_with('d')) told.remove_suffix(1);
      const auto value = number<std::size_t>(told);
      if (!value || *value == 0 || *value >= dimensions || word.size() > 2 || word[0] != "LIST")
        refuse(path, fmt::format("its ElementDataFile is {}, which makes no sense", shown(data_file)), kMendHeader);
      inside = *value;
    }
    names = listed_names(lines);
    // It drops a last name without an end of line.
    if (!names.empty() && !lines.ends_with('\n') && lines.size() < kLongestTextHeader / 2)
      refuse(path, "its last line, a name of a file, has no end", "end it with a new line");
  } else {
    std::array<std::int64_t, 3> range{1, parts.size.back(), 1};
    if (word.size() == 2 || word.size() == 4)
      for (std::size_t i = 1; i < word.size(); ++i) range[i - 1] = number<int>(word[i]).value_or(0);
    else if (word.size() != 1)
      refuse(path, fmt::format("its ElementDataFile is {}", shown(data_file)),
             "write a pattern without blanks and three numbers, as in slice%03d.raw 1 20 1");
    if (word.size() == 2) range[1] = range[0] + parts.size.back() - 1;
    if (range[2] < 1) refuse(path, "the numbers of its data files make no sense", kMendHeader);
    names = names_of(path, word[0], range);
  }
  double files = 1, bytes = static_cast<double>(parts.channels);
  for (std::size_t i = 0; i < dimensions; ++i) (i < inside ? bytes : files) *= static_cast<double>(parts.size[i]);
  constexpr std::array<std::pair<const char*, int>, 12> kBytes{{{"CHAR", 1},
                                                                {"UCHAR", 1},
                                                                {"SHORT", 2},
                                                                {"USHORT", 2},
                                                                {"INT", 4},
                                                                {"UINT", 4},
                                                                {"LONG", 4},
                                                                {"ULONG", 4},
                                                                {"FLOAT", 4},
                                                                {"DOUBLE", 8},
                                                                {"LONG_LONG", 8},
                                                                {"ULONG_LONG", 8}}};
  const auto type = std::find_if(kBytes.begin(), kBytes.end(),
                                 [&](const auto& known) { return parts.type == std::string("MET_") + known.first; });
  if (type == kBytes.end()) refuse(path, "its header does not tell the type of its values", kMendHeader);
  bytes *= type->second;
  if (static_cast<double>(names.size()) != files)
    refuse(path, fmt::format("its header tells of {} slices, but names {} files for them", files, names.size()),
           kMendHeader);
  const auto needed = bytes + static_cast<double>(std::max(parts.skipped, std::int64_t{0}));
  for (const std::string& name : names) {
    if (name.empty() || name.size() > 200 || name.back() < 0x20 || name.back() > 0x7e)
      refuse(path, fmt::format("it names {} as a data file, which is no name that can be read", shown(name)),
             kMendHeader);
    if (const std::uint64_t size = part_size(path, name); static_cast<double>(size) < needed)
      refuse(path, fmt::format("its data file {} has {} bytes, but a slice needs {}", shown(name), size, needed),
             kAgain);
  }
}

ValueLocation nrrd_location(const fs::path& path) {
  ValueLocation location;
  std::string data_file;
  std::uint64_t header = 0;
  std::int64_t lines = 0, bytes = 0;
  const std::string head = head_of(path, kLongestTextHeader);
  for_each_field(head, ":", [&](const std::string& name, const std::string& value, std::uint64_t end) {
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
    return !key.empty() && !data_file.starts_with("LIST");
  });
  const std::vector<std::string_view> word = words(data_file);
  const bool listed = !word.empty() && word[0] == "LIST";
  // A blank alone does not make a pattern: it may be part of a name.
  if (listed || (word.size() >= 4 && word[0].find('%') != std::string_view::npos)) {
    if (location.packing == Packing::text || location.packing == Packing::hex)
      refuse(path, "its values are text in several files", kOneFile);
    std::array<std::int64_t, 3> range{};
    for (std::size_t i = 0; i < 3 && !listed; ++i) range[i] = number<int>(word[i + 1]).value_or(0);
    const std::vector<std::string> names =
        listed ? listed_names(std::string_view(head).substr(std::min<std::size_t>(header, head.size())))
               : names_of(path, word[0], range);
    for (const std::string& name : names) location.available += part_size(path, name);
    location.direct = false;
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
  MetaParts parts;
  const std::string head = head_of(path, kLongestTextHeader);
  const auto is_true = [](const std::string& value) {
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
  };
  for_each_field(head, "=:", [&](const std::string& key, const std::string& value, std::uint64_t end) {
    header = end;
    if (key == "CompressedData" && is_true(value)) location.packing = Packing::compressed;
    if ((key == "BinaryData" || key == "Binary") && !is_true(value)) location.packing = Packing::text;
    if (key == "BinaryDataByteOrderMSB" || key == "ElementByteOrderMSB") most_significant_first = is_true(value);
    if (key == "CompressedDataSize") packed_size = value;
    if (key == "HeaderSize") skipped = number<std::int64_t>(value).value_or(-2);
    if (key == "ElementType") parts.type = value.substr(0, value.find("_ARRAY"));
    if (key == "ElementNumberOfChannels") parts.channels = number<int>(value).value_or(-1);
    if (key == "DimSize") {
      parts.size.clear();
      for (const std::string_view size : words(value)) parts.size.push_back(number<std::int64_t>(size).value_or(0));
    }
    if (key == "ElementDataFile") data_file = value;
    return key != "ElementDataFile";
  });
  const bool local = data_file == "LOCAL" || data_file == "Local" || data_file == "local";
  if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos) {
    if (location.packing != Packing::raw)
      refuse(path, "its values are in several files, compressed or as text", kOneFile);
    parts.skipped = skipped;
    check_meta_parts(path, data_file, std::string_view(head).substr(std::min<std::size_t>(header, head.size())), parts);
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
    // The standard: with a slope of 0 values are not scaled at all, whatever the intercept. The NIfTI library takes
    // what is no number for 0.
    if (std::isfinite(header.slope()) && header.slope() != 0) {
      location.slope = header.slope();
      if (std::isfinite(header.intercept())) location.intercept = header.intercept();
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
