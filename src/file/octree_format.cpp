#include "file/octree_format.h"

#include <nlohmann/json.hpp>

namespace blackleaf::detail::format {
namespace {

// Strict UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing beyond U+10FFFF.
bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : '\0'); };
    const unsigned lead = byte(at);
    const std::size_t more = lead < 0x80 ? 0 : lead >= 0xC2 && lead < 0xE0 ? 1 : lead >= 0xE0 && lead < 0xF0 ? 2 : 3;
    if (more == 3 && (lead < 0xF0 || lead > 0xF4)) return false;
    for (std::size_t i = 1; i <= more; ++i)
      if ((byte(at + i) & 0xC0) != 0x80) return false;
    const unsigned second = byte(at + 1);
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) || (lead == 0xF0 && second < 0x90) ||
        (lead == 0xF4 && second > 0x8F))
      return false;
    at += more + 1;
  }
  return true;
}

}  // namespace

std::string_view unit_problem(std::string_view unit) {
  if (unit.size() > kMaxUnitBytes) return "the unit's name is longer than 255 bytes";
  if (!is_utf8(unit)) return "the unit's name is not UTF-8";
  for (const char c : unit)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) return "the unit's name has control characters";
  return {};
}

std::string_view metadata_problem(std::string_view metadata) {
  if (metadata.size() > kMaxMetadataBytes) return "the metadata are longer than 16 MiB";
  const std::size_t first = metadata.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || metadata[first] != '{' || !nlohmann::json::accept(metadata))
    return "the metadata are not a JSON object";
  return {};
}

}  // namespace blackleaf::detail::format
