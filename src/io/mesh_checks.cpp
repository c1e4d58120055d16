#include "io/mesh_checks.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

constexpr const char* kCutOff = "the file was cut off, get it again";
constexpr const char* kDamaged = "it is damaged, get it again";

[[noreturn]] void refuse(const std::string& name, const std::string& what, const char* remedy) {
  throw Error(ErrorCode::bad_input, name + ": " + what, remedy);
}

// The bytes of a file from a position on, in order.
class Bytes {
 public:
  Bytes(const InputFile& file, std::uint64_t from) : file_(file), next_(from) {}

  std::uint64_t position() const { return next_ - (held_ - at_); }
  std::uint64_t left() const { return file_.size() - position(); }
  // -1 at the end.
  int get() {
    if (at_ == held_ && !fill()) return -1;
    return buffer_[at_++];
  }
  int peek() {
    if (at_ == held_ && !fill()) return -1;
    return buffer_[at_];
  }
  // False, and nothing skipped, when there are fewer.
  bool skip(std::uint64_t count) {
    if (count > left()) return false;
    if (count <= held_ - at_) {
      at_ += static_cast<std::size_t>(count);
    } else {
      next_ = position() + count;
      at_ = held_ = 0;
    }
    return true;
  }
  // The next line that has more than blanks and comments ('#' to its end); false at the end of the file. What goes
  // beyond 64 KiB in one line is dropped.
  bool line(std::string& text) {
    do {
      text.clear();
      bool comment = false;
      int c = get();
      if (c < 0) return false;
      for (; c >= 0 && c != '\n' && c != '\r'; c = get()) {
        comment = comment || c == '#';
        if (!comment && text.size() < 65536) text += static_cast<char>(c);
      }
    } while (text.find_first_not_of(" \t\v\f") == std::string::npos);
    return true;
  }

 private:
  bool fill() {
    const std::uint64_t rest = file_.size() - next_;
    held_ = static_cast<std::size_t>(std::min<std::uint64_t>(rest, buffer_.size()));
    at_ = 0;
    if (held_ == 0) return false;
    file_.read_at(next_, std::span(buffer_).first(held_));
    next_ += held_;
    return true;
  }

  const InputFile& file_;
  std::uint64_t next_;  // where in the file the buffer ends
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(std::size_t{1} << 16);
  std::size_t at_ = 0, held_ = 0;
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\v\f", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \t\v\f", at), text.size());
    result.push_back(text.substr(at, end - at));
    at = end;
  }
  return result;
}

// A whole number that fills the word.
std::optional<std::uint64_t> whole_number(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

// ---- STL

void check_stl(const InputFile& file, const std::string& name) {
  constexpr std::uint64_t kHeader = 84, kTriangle = 50;
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 65536)), '\0');
  file.read_at(0, {reinterpret_cast<std::uint8_t*>(head.data()), head.size()});
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  const bool solid = first != std::string::npos && lower(head.substr(first, 5)) == "solid";
  if (file.size() < kHeader) {
    if (solid || std::all_of(head.begin(), head.end(), [](unsigned char c) { return c >= 9 && c < 127; })) return;
    refuse(name, fmt::format("has {} bytes, fewer than the {} of an STL header", file.size(), kHeader), kCutOff);
  }
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < 4; ++i)
    triangles |= static_cast<std::uint64_t>(static_cast<unsigned char>(head[80 + i])) << (8 * i);
  const std::uint64_t wanted = kHeader + kTriangle * triangles;
  if (wanted == file.size()) return;
  // Text of some kind, as all of its beginning is.
  if (solid && lower(head).find("facet") != std::string::npos) return;
  if (std::all_of(head.begin(), head.begin() + kHeader, [](unsigned char c) { return c >= 9 && c < 127; })) return;
  refuse(
      name,
      fmt::format("its header tells of {} triangles ({} bytes) but there are {} bytes", triangles, wanted, file.size()),
      wanted > file.size() ? kCutOff : kDamaged);
}

// ---- OFF

void check_off(const InputFile& file, const std::string& name) {
  Bytes bytes(file, 0);
  std::string line;
  std::vector<std::string> numbers;  // of the header, which may be spread over lines: vertices, faces, edges
  bool keyword = false;
  while (numbers.size() < 2) {
    if (!bytes.line(line)) {
      if (!keyword) return;
      refuse(name, "its header has no numbers of vertices and faces", kCutOff);
    }
    auto parts = words(line);
    if (!keyword) {
      const std::string_view word = parts.front();
      // A dimension of its own ("n") and other beginnings: the reader proper knows what to do.
      if (!word.ends_with("OFF") || word.find('n') != std::string_view::npos) return;
      keyword = true;
      parts.erase(parts.begin());
    }
    for (const auto part : parts) {
      if (!whole_number(part)) {
        if (part == "BINARY") return;
        refuse(name, fmt::format("its header has \"{}\" where a number should be", part.substr(0, 20)), kDamaged);
      }
      numbers.emplace_back(part);
    }
  }
  const std::uint64_t vertices = *whole_number(numbers[0]), faces = *whole_number(numbers[1]);
  // The edge count may stand on a line of its own; then it is the first of the lines below, and one number only.
  const std::string counts = fmt::format("its header tells of {} vertices and {} faces", vertices, faces);
  if (vertices > file.size() / 2 || faces > file.size() / 2)  // a line has two bytes at least
    refuse(name, fmt::format("{} but there are {} bytes", counts, file.size()), kCutOff);
  bool pending = false;  // a line read ahead
  if (numbers.size() == 2 && bytes.line(line)) pending = words(line).size() != 1;
  const auto next = [&](const char* what, std::uint64_t found) {
    if (std::exchange(pending, false)) return;
    if (!bytes.line(line)) refuse(name, fmt::format("{} but there are {} {}", counts, found, what), kCutOff);
  };
  for (std::uint64_t i = 0; i < vertices; ++i) next("vertices", i);
  for (std::uint64_t i = 0; i < faces; ++i) {
    next("faces", i);
    const char* at = line.data();
    const char* const end = at + line.size();
    const auto number = [&]() -> std::optional<std::uint64_t> {
      while (at < end && (*at == ' ' || *at == '\t')) ++at;
      std::uint64_t value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc{}) return std::nullopt;
      at = stop;
      return value;
    };
    const auto size = number();
    if (!size) refuse(name, fmt::format("face {} does not begin with its number of vertices", i), kDamaged);
    for (std::uint64_t k = 0; k < *size; ++k) {
      const auto vertex = number();
      if (!vertex) {
        if (line.size() >= 65536) break;  // the rest of the line was dropped
        refuse(name, fmt::format("face {} tells of {} vertices but names {}", i, *size, k),
               bytes.left() == 0 ? kCutOff : kDamaged);
      }
      if (*vertex >= vertices)
        refuse(name,
               fmt::format("face {} refers to vertex {}, and the last is {}", i, *vertex,
                           static_cast<std::int64_t>(vertices) - 1),
               kDamaged);
    }
  }
}

// ---- PLY

unsigned type_size(std::string_view type) {
  static const std::map<std::string_view, unsigned> sizes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

struct PlyProperty {
  unsigned count_size;  // bytes of a list's length; 0 for a single number
  unsigned size;        // bytes of a number
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
  std::uint64_t end = 0;  // where the data begin
  bool known = true;      // all types are
};

PlyHeader ply_header(std::string_view head, const std::string& name, bool whole) {
  PlyHeader header;
  // Old systems end lines by '\r' alone, others by '\n' or both; the first line tells, as binary data may follow.
  const std::size_t first = head.find_first_of("\r\n");
  const bool lone =
      first != std::string_view::npos && head[first] == '\r' && (first + 1 >= head.size() || head[first + 1] != '\n');
  for (std::size_t at = 0;;) {
    const std::size_t end = head.find(lone ? '\r' : '\n', at);
    std::string_view line = head.substr(at, end == std::string_view::npos ? end : end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const auto parts = words(line);
    const bool last = !parts.empty() && parts.front() == "end_header";
    if (end == std::string_view::npos && !(last && whole))
      refuse(name, whole ? "its header has no end_header" : "its header has no end_header in its first 64 KiB",
             whole ? kCutOff : kDamaged);
    at = std::min(end, head.size() - 1) + 1;
    if (last) {
      header.end = at;
      return header;
    }
    if (parts.size() >= 2 && parts[0] == "format") header.format = parts[1];
    if (!parts.empty() && parts[0] == "element") {
      const auto count = parts.size() == 3 ? whole_number(parts[2]) : std::nullopt;
      if (!count) refuse(name, fmt::format("its header has no good count in \"{}\"", line.substr(0, 60)), kDamaged);
      header.elements.push_back({std::string(parts[1]), *count, {}});
    }
    if (!parts.empty() && parts[0] == "property") {
      PlyProperty property{};
      if (parts.size() == 5 && parts[1] == "list") {
        property = {type_size(parts[2]), type_size(parts[3])};
        if (property.count_size == 0 || property.count_size > 4) header.known = false;
      } else if (parts.size() == 3) {
        property = {0, type_size(parts[1])};
      }
      if (property.size == 0 || header.elements.empty()) header.known = false;
      if (!header.elements.empty()) header.elements.back().properties.push_back(property);
    }
  }
}

void check_ply_text(const InputFile& file, const std::string& name, const PlyHeader& header) {
  Bytes bytes(file, header.end);
  std::string line;
  for (const PlyElement& element : header.elements) {
    const auto fail = [&](std::uint64_t found) {
      refuse(name, fmt::format("its header tells of {} of \"{}\" but there are {}", element.count, element.name, found),
             kCutOff);
    };
    if (element.properties.empty()) return;  // whether it has lines is not said
    for (std::uint64_t i = 0; i < element.count; ++i)
      if (!bytes.line(line)) fail(i);
  }
}

void check_ply_binary(const InputFile& file, const std::string& name, const PlyHeader& header) {
  Bytes bytes(file, header.end);
  const bool big = header.format == "binary_big_endian";
  for (const PlyElement& element : header.elements) {
    const auto fail = [&](std::uint64_t found) {
      refuse(name,
             fmt::format("its header tells of {} of \"{}\" but there are bytes for {}", element.count, element.name,
                         found),
             kCutOff);
    };
    std::uint64_t fixed = 0;
    bool lists = false;
    for (const PlyProperty& property : element.properties) {
      fixed += property.count_size > 0 ? property.count_size : property.size;
      lists = lists || property.count_size > 0;
    }
    if (fixed == 0) continue;
    if (element.count > bytes.left() / fixed) fail(bytes.left() / fixed);
    if (!lists) {
      bytes.skip(element.count * fixed);
      continue;
    }
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t size = property.size;
        if (property.count_size > 0) {
          std::uint64_t length = 0;
          for (unsigned k = 0; k < property.count_size; ++k) {
            const int byte = bytes.get();
            if (byte < 0) fail(i);
            length |= static_cast<std::uint64_t>(byte) << (8 * (big ? property.count_size - 1 - k : k));
          }
          size *= length;
        }
        if (!bytes.skip(size)) fail(i);
      }
  }
}

void check_ply(const InputFile& file, const std::string& name) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 65536)), '\0');
  file.read_at(0, {reinterpret_cast<std::uint8_t*>(head.data()), head.size()});
  if (lower(head.substr(0, 3)) != "ply") return;
  const PlyHeader header = ply_header(head, name, head.size() == file.size());
  if (header.format == "ascii")
    check_ply_text(file, name, header);
  else if (header.known && header.format.starts_with("binary_"))
    check_ply_binary(file, name, header);
}

}  // namespace

void check_mesh_file(const InputFile& file, const std::filesystem::path& path) {
  const std::string suffix = lower(path.extension().string()), name = path.string();
  if (suffix == ".stl") check_stl(file, name);
  if (suffix == ".off") check_off(file, name);
  if (suffix == ".ply") check_ply(file, name);
}

}  // namespace blackleaf::detail
