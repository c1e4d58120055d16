// What the readers of mesh files in text share: bytes, lines and words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/input_file.h"

namespace blackleaf::detail {

inline constexpr const char* kCutOff = "the file was cut off, get it again";
inline constexpr const char* kDamaged = "it is damaged, get it again";

/// The bytes of a file from a position on, in order; reading them throws Error(cancelled) when the program is to stop.
/// Requires: file.is_regular(), and it outlives this.
class MeshBytes {
 public:
  MeshBytes(const InputFile& file, std::uint64_t from) : file_(file), next_(from) {}

  std::uint64_t position() const { return next_ - (held_ - at_); }
  std::uint64_t left() const { return file_.size() - position(); }
  /// -1 at the end.
  int get() {
    if (at_ == held_ && !fill()) return -1;
    return buffer_[at_++];
  }
  /// False, and nothing skipped, when there are fewer.
  bool skip(std::uint64_t count);
  /// The next line that has more than blanks and comments ('#' to its end); false at the end of the file. What goes
  /// beyond `most` bytes in one line is dropped, so that a file without line ends takes no memory.
  bool line(std::string& text, std::size_t most = 65536);

 private:
  bool fill();

  const InputFile& file_;
  std::uint64_t next_;  // where in the file the buffer ends
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(std::size_t{1} << 16);
  std::size_t at_ = 0, held_ = 0;
};

/// Split at blanks.
std::vector<std::string_view> split_words(std::string_view text);
/// The decimal number that a word is, all of it; "nan" and "inf" are numbers. Too small for a double is 0, too large is
/// infinite.
std::optional<double> decimal(std::string_view word);

}  // namespace blackleaf::detail
