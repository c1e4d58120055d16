// Reading files byte by byte and line by line, and the words and numbers in a line.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file/input_file.h"
#include "file/stop_check.h"
#include "io/header_text.h"

namespace blackleaf::detail {

inline constexpr const char* kCutOff = "the file was cut off, get it again";
inline constexpr const char* kDamaged = "it is damaged, get it again";

/// The bytes of a file from a position on, in order; reading them throws Error(cancelled) when the program is to stop.
class Bytes {
 public:
  /// Requires: file.is_regular(), and that it lives as long as this object.
  Bytes(const InputFile& file, std::uint64_t from) : file_(file), next_(from) {}

  std::uint64_t position() const { return next_ - (held_ - at_); }
  std::uint64_t left() const { return file_.size() - position(); }
  /// -1 at the end.
  int get() {
    if (at_ == held_ && !fill()) return -1;
    return buffer_[at_++];
  }
  int peek() {
    if (at_ == held_ && !fill()) return -1;
    return buffer_[at_];
  }
  /// False, and nothing skipped, when there are fewer.
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
  /// The next bytes, as many as fit and are there.
  std::size_t read(std::span<std::uint8_t> bytes) {
    std::size_t done = 0;
    while (done < bytes.size() && (at_ < held_ || fill())) {
      const std::size_t part = std::min(bytes.size() - done, held_ - at_);
      std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), part,
                  bytes.begin() + static_cast<std::ptrdiff_t>(done));
      at_ += part;
      done += part;
    }
    return done;
  }
  /// The next line that has more than blanks and comments ('#' to its end); false at the end of the file. What goes
  /// beyond `most` bytes in one line is dropped, so that a file without line ends takes no memory.
  bool line(std::string& text, std::size_t most = 65536) {
    do {
      text.clear();
      bool comment = false;
      int c = get();
      if (c < 0) return false;
      for (; c >= 0 && c != '\n' && c != '\r'; c = get()) {
        comment = comment || c == '#';
        if (!comment && text.size() < most) text += static_cast<char>(c);
      }
      // "\r\n" ends one line.
      if (c == '\r' && peek() == '\n') get();
      ++lines_;
    } while (text.find_first_not_of(" \t\v\f") == std::string::npos);
    return true;
  }
  /// The number of the line that line() gave last, from where reading began, counted from 1.
  std::uint64_t line_number() const { return lines_; }

 private:
  bool fill() {
    check_for_stop();
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
  std::uint64_t lines_ = 0;
};

/// Throws Error(bad_input) if there are more lines than blanks and comments behind what has been read, which the
/// message calls `what`.
inline void require_end(Bytes& bytes, const std::string& name, const char* what) {
  std::string line;
  if (bytes.line(line))
    refuse(name, "has more data behind " + std::string(what) + ": " + shown(line), "mend the numbers in its header");
}

/// A whole number that fills the word.
inline std::optional<std::uint64_t> whole_number(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A number that fills the word, in decimal notation; "nan" and "inf" are numbers, and what is beyond the doubles is
/// infinite. None for anything else.
inline std::optional<double> decimal(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
  return value;
}

}  // namespace blackleaf::detail
