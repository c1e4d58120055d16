#include "io/text_values.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "file/input_file.h"
#include "io/header_text.h"

namespace blackleaf::detail {
namespace {

template <class T>
bool holds(std::string_view word) {
  if constexpr (std::is_floating_point_v<T>) {
    // Numbers too large or too small become infinity or 0, as everywhere.
    if (word.starts_with('+')) word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error != std::errc::invalid_argument && end == word.data() + word.size();
  } else {
    return number<T>(word).has_value();
  }
}

bool holds(Component component, std::string_view word) {
  return with_type_of(component, [&]<class T>(T) { return holds<T>(word); });
}

bool is_gap(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

// Calls take(character) for all of the values' characters, until it returns false.
template <class Take>
void for_each_character(const ValueLocation& location, const Take& take) {
  const InputFile file(location.file);
  std::array<char, 1 << 16> part{};
  for (std::uint64_t at = 0; at < location.available;) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(part.size(), location.available - at));
    file.read_at(location.offset + at, {reinterpret_cast<std::uint8_t*>(part.data()), size});
    at += size;
    for (std::size_t i = 0; i < size; ++i)
      if (!take(part[i])) return;
  }
}

}  // namespace

void check_text_values(const std::filesystem::path& path, const ValueLocation& location, Component component,
                       std::uint64_t voxels) {
  constexpr std::size_t kLongestWord = 100;
  std::string word;
  std::uint64_t found = 0;
  const auto end_word = [&] {
    if (word.empty()) return;
    if (found == voxels)
      refuse(path, fmt::format("its header tells of {} voxels, but there are more numbers: {}", voxels, shown(word)),
             "mend the size in its header");
    if (!holds(component, word))
      refuse(path, fmt::format("value {} is {}, which its type cannot hold", found + 1, shown(word)),
             "mend the type in its header or the value");
    word.clear();
    ++found;
  };
  for_each_character(location, [&](char c) {
    if (!is_gap(c) && word.size() < kLongestWord)
      word += c;
    else
      end_word();
    return true;
  });
  end_word();
  if (found < voxels)
    refuse(path, fmt::format("its header tells of {} voxels, but there are {} numbers", voxels, found), kAgain);
}

void check_hex_values(const std::filesystem::path& path, const ValueLocation& location, std::uint64_t digits) {
  std::uint64_t found = 0;
  for_each_character(location, [&](char c) {
    if (is_gap(c)) return true;
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0)
      refuse(path, fmt::format("its values have {} after {} hexadecimal digits", shown({&c, 1}), found), kAgain);
    return ++found <= digits;
  });
  if (found != digits)
    refuse(path,
           fmt::format("its header tells of values of {} hexadecimal digits, but there are {}", digits,
                       found < digits ? std::to_string(found) : "more"),
           found < digits ? kAgain : "mend the size in its header");
}

}  // namespace blackleaf::detail
