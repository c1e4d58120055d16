#include "io/ply_header.h"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "io/file_text.h"

namespace blackleaf::detail {
namespace {

std::optional<Component> type_of(std::string_view type) {
  using enum Component;
  static const std::map<std::string_view, Component> types = {
      {"char", i8},   {"uchar", u8},    {"int8", i8},    {"uint8", u8},   {"short", i16}, {"ushort", u16},
      {"int16", i16}, {"uint16", u16},  {"int", i32},    {"uint", u32},   {"int32", i32}, {"uint32", u32},
      {"float", f32}, {"float32", f32}, {"double", f64}, {"float64", f64}};
  const auto found = types.find(type);
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

PlyHeader parse(std::string_view head, const std::string& name, bool whole) {
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
      PlyProperty property;
      if (parts.size() == 5 && parts[1] == "list") {
        property = {std::string(parts[4]), type_of(parts[2]), type_of(parts[3])};
        if (property.count_size() == 0 || property.count_size() > 4) header.known = false;
      } else if (parts.size() == 3) {
        property = {std::string(parts[2]), {}, type_of(parts[1])};
      }
      if (property.size() == 0 || header.elements.empty()) header.known = false;
      if (!header.elements.empty()) header.elements.back().properties.push_back(property);
    }
  }
}

}  // namespace

std::optional<PlyHeader> read_ply_header(const InputFile& file, const std::string& name) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 65536)), '\0');
  file.read_at(0, {reinterpret_cast<std::uint8_t*>(head.data()), head.size()});
  if (lower(head.substr(0, 3)) != "ply") return std::nullopt;
  return parse(head, name, head.size() == file.size());
}

void check_ply_end(const PlyHeader& header, std::uint64_t left, const std::string& name) {
  const PlyElement* last = nullptr;
  std::uint64_t size = 0;  // of one of the last element that is there
  for (const PlyElement& element : header.elements) {
    std::uint64_t sum = 0;
    for (const PlyProperty& property : element.properties)
      sum += property.is_list() ? property.count_size() + std::uint64_t{3} * property.size() : property.size();
    if (element.count == 0 || sum == 0) continue;
    last = &element;
    size = sum;
  }
  if (last == nullptr || left < size) return;
  refuse(
      name,
      fmt::format("its header tells of {} of \"{}\" but there are {} bytes behind them", last->count, last->name, left),
      "mend the numbers in its header");
}

}  // namespace blackleaf::detail
