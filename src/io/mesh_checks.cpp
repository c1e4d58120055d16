#include "io/mesh_checks.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/file_text.h"
#include "io/ply_header.h"

namespace blackleaf::detail {
namespace {

// ---- STL

// Throws, or tells whether it is text.
bool check_stl(const InputFile& file, const std::string& name) {
  constexpr std::uint64_t kHeader = 84, kTriangle = 50;
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 65536)), '\0');
  file.read_at(0, {reinterpret_cast<std::uint8_t*>(head.data()), head.size()});
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  const bool solid = first != std::string::npos && lower(head.substr(first, 5)) == "solid";
  const bool printable =
      std::all_of(head.begin(), head.begin() + static_cast<std::ptrdiff_t>(std::min(head.size(), kHeader)),
                  [](unsigned char c) { return c >= 9 && c < 127; });
  if (file.size() < kHeader) {
    if (solid || printable) return true;
    refuse(name, fmt::format("has {} bytes, fewer than the {} of an STL header", file.size(), kHeader), kCutOff);
  }
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < 4; ++i)
    triangles |= static_cast<std::uint64_t>(static_cast<unsigned char>(head[80 + i])) << (8 * i);
  const std::uint64_t wanted = kHeader + kTriangle * triangles;
  if (wanted == file.size() && triangles == 0) refuse(name, "has no triangles", "give a surface, not points or lines");
  if (wanted == file.size()) return false;
  if ((solid && lower(head).find("facet") != std::string::npos) || printable) return true;
  refuse(
      name,
      fmt::format("its header tells of {} triangles ({} bytes) but there are {} bytes", triangles, wanted, file.size()),
      wanted > file.size() ? kCutOff : kDamaged);
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
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (!bytes.line(line)) fail(i);
      if (!header.known || line.size() >= 65536) continue;  // part of it may have been dropped
      const auto numbers = words(line);
      std::uint64_t wanted = 0;
      for (const PlyProperty& property : element.properties) {
        std::uint64_t list = 0;
        if (property.count_size() > 0 && wanted < numbers.size())
          list = std::min<std::uint64_t>(number<std::uint64_t>(numbers[wanted]).value_or(0), file.size());
        wanted += 1 + list;
      }
      if (numbers.size() < wanted)
        refuse(name, fmt::format("\"{}\" {} has {} numbers instead of {}", element.name, i, numbers.size(), wanted),
               bytes.left() == 0 ? kCutOff : kDamaged);
    }
  }
  require_end(bytes, name, "the last element that its header tells of");
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
  check_ply_end(header, bytes.left(), name);
}

void check_ply(const InputFile& file, const std::string& name) {
  const std::optional<PlyHeader> header = read_ply_header(file, name);
  if (!header) return;
  if (header->format == "ascii")
    check_ply_text(file, name, *header);
  else if (header->known && header->format.starts_with("binary_"))
    check_ply_binary(file, name, *header);
}

// ---- OBJ

// assimp passes over vertices of other numbers of coordinates, and all faces then refer to wrong ones.
void check_obj(const InputFile& file, const std::string& name) {
  Bytes bytes(file, 0);
  std::string line;
  bool continued = false;  // a backslash at its end joined the line before to this one
  for (std::uint64_t vertices = 0; bytes.line(line);) {
    const bool joined = std::exchange(continued, line.ends_with('\\'));
    const std::size_t first = line.find_first_not_of(" \t");
    if (joined || line[first] != 'v' || first + 1 >= line.size()) continue;
    if (line[first + 1] != ' ' && line[first + 1] != '\t') continue;  // vn, vt, vp
    ++vertices;
    if (continued || line.size() >= 65536) continue;
    const auto parts = words(line);
    std::size_t numbers = 0;
    while (numbers + 1 < parts.size() && decimal(parts[numbers + 1])) ++numbers;
    if (numbers != 3 && numbers != 4 && numbers != 6)
      refuse(name, fmt::format("vertex {} has {} coordinates ({})", vertices, numbers, shown(line.substr(first))),
             "give it 3, 4 or, with a colour, 6");
  }
}

}  // namespace

bool is_stl_text(const InputFile& file, const std::filesystem::path& path) {
  return lower(path.extension().string()) == ".stl" && check_stl(file, path.string());
}

void check_mesh_file(const InputFile& file, const std::filesystem::path& path) {
  const std::string suffix = lower(path.extension().string()), name = path.string();
  if (suffix == ".ply") check_ply(file, name);
  if (suffix == ".obj") check_obj(file, name);
}

}  // namespace blackleaf::detail
