#include "io/text_values.h"

#include <algorithm>
#include <array>
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

}  // namespace

void check_text_values(const std::filesystem::path& path, const ValueLocation& location, Component component,
                       std::uint64_t voxels) {
  constexpr std::size_t kLongestWord = 100;
  const InputFile file(location.file);
  std::array<char, 1 << 16> part{};
  std::string word;
  std::uint64_t found = 0;
  const auto end_word = [&] {
    if (word.empty()) return;
    if (!holds(component, word))
      refuse(path, fmt::format("value {} is {}, which its type cannot hold", found + 1, shown(word)),
             "mend the type in its header or the value");
    word.clear();
    ++found;
  };
  for (std::uint64_t at = 0; at < location.available && found < voxels;) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(part.size(), location.available - at));
    file.read_at(location.offset + at, {reinterpret_cast<std::uint8_t*>(part.data()), size});
    at += size;
    for (std::size_t i = 0; i < size && found < voxels; ++i) {
      if (!is_gap(part[i]) && word.size() < kLongestWord)
        word += part[i];
      else
        end_word();
    }
  }
  if (found < voxels) end_word();
  if (found < voxels)
    refuse(path, fmt::format("its header tells of {} voxels, but there are {} numbers", voxels, found), kAgain);
}

}  // namespace blackleaf::detail
