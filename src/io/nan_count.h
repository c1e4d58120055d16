// NanCount: what is said of a volume's values that are no numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "io/header_text.h"

namespace blackleaf::detail {

class NanCount {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    if constexpr (std::is_floating_point_v<T>)
      nan_ +=
          static_cast<std::uint64_t>(std::count_if(values, values + count, [](T value) { return std::isnan(value); }));
    all_ += count;
  }
  NanCount() = default;
  /// Counts that were made elsewhere.
  NanCount(std::uint64_t nan, std::uint64_t all) : nan_(nan), all_(all) {}
  std::uint64_t nan() const { return nan_; }
  std::uint64_t all() const { return all_; }

  /// After the last value: throws Error(bad_input) if all were NaN, warns of some, saying what becomes of them.
  void tell(const std::filesystem::path& path, const char* fate,
            const std::function<void(const std::string&)>& warn) const {
    if (nan_ == all_) refuse(path, "every value is NaN", kAgain);
    if (nan_ > 0 && warn)
      warn(fmt::format("{}: {} of {} values {} NaN and {}", path.string(), nan_, all_, nan_ == 1 ? "is" : "are", fate));
  }

 private:
  std::uint64_t nan_ = 0, all_ = 0;
};

}  // namespace blackleaf::detail
