#include "io/mesh_checks.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/file_text.h"
#include "io/ply_header.h"

namespace blackleaf::detail {
namespace {

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
      fixed += property.is_list() ? property.count_size() : property.size();
      lists = lists || property.is_list();
    }
    if (fixed == 0) continue;
    if (element.count > bytes.left() / fixed) fail(bytes.left() / fixed);
    if (!lists) {
      bytes.skip(element.count * fixed);
      continue;
    }
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t size = property.size();
        if (property.count_size() > 0) {
          std::uint64_t length = 0;
          for (unsigned k = 0; k < property.count_size(); ++k) {
            const int byte = bytes.get();
            if (byte < 0) fail(i);
            length |= static_cast<std::uint64_t>(byte) << (8 * (big ? property.count_size() - 1 - k : k));
          }
          size *= length;
        }
        if (!bytes.skip(size)) fail(i);
      }
  }
}

void check_ply(const InputFile& file, const std::string& name) {
  const std::optional<PlyHeader> header = read_ply_header(file, name);
  if (!header) return;
  if (header->format == "ascii")
    check_ply_text(file, name, *header);
  else if (header->known && header->format.starts_with("binary_"))
    check_ply_binary(file, name, *header);
}

}  // namespace

void check_mesh_file(const InputFile& file, const std::filesystem::path& path) {
  const std::string suffix = lower(path.extension().string()), name = path.string();
  if (suffix == ".stl") check_stl(file, name);
  if (suffix == ".off") check_off(file, name);
  if (suffix == ".ply") check_ply(file, name);
}

}  // namespace blackleaf::detail
