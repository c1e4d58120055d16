// Headers as text: what the checks of volume headers and mesh files share.
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blackleaf::detail {

/// Remedies that many messages share.
inline constexpr const char* kAgain = "get it again from its source";
inline constexpr const char* kMendHeader = "mend its header or get it again from its source";

/// Longest header in text that is looked at, in bytes.
inline constexpr std::size_t kLongestTextHeader = std::size_t{1} << 20;

/// Throws Error(bad_input) of a message that begins with the file's name.
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, const std::string& remedy);

/// A header's word as a message can show it.
std::string shown(std::string_view text);
/// Its words, between blanks.
std::vector<std::string_view> words(std::string_view text);
/// Without blanks at its ends.
std::string trimmed(std::string_view text);
/// In small letters (ASCII).
std::string lower(std::string text);

/// The number that a word is, all of it.
template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The first bytes of a file, `limit` at most; and those of what a gzip file unpacks to.
std::string head_of(const std::filesystem::path& path, std::size_t limit);
std::string unpacked_head_of(const std::filesystem::path& path, unsigned limit);

/// A field is a key, one of the separators, and a value. Calls line(key, value, offset behind the line) until it
/// returns false or the lines end.
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

}  // namespace blackleaf::detail
