#include "io/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <span>

#include "file/stop_check.h"

namespace blackleaf::detail {

bool MeshBytes::skip(std::uint64_t count) {
  if (count > left()) return false;
  if (count <= held_ - at_) {
    at_ += static_cast<std::size_t>(count);
  } else {
    next_ = position() + count;
    at_ = held_ = 0;
  }
  return true;
}

bool MeshBytes::line(std::string& text, std::size_t most) {
  do {
    text.clear();
    bool comment = false;
    int c = get();
    if (c < 0) return false;
    for (; c >= 0 && c != '\n' && c != '\r'; c = get()) {
      comment = comment || c == '#';
      if (!comment && text.size() < most) text += static_cast<char>(c);
    }
  } while (text.find_first_not_of(" \t\v\f") == std::string::npos);
  return true;
}

bool MeshBytes::fill() {
  check_for_stop();
  const std::uint64_t rest = file_.size() - next_;
  held_ = static_cast<std::size_t>(std::min<std::uint64_t>(rest, buffer_.size()));
  at_ = 0;
  if (held_ == 0) return false;
  file_.read_at(next_, std::span(buffer_).first(held_));
  next_ += held_;
  return true;
}

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> result;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\v\f", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \t\v\f", at), text.size());
    result.push_back(text.substr(at, end - at));
    at = end;
  }
  return result;
}

std::optional<double> decimal(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
  if (error != std::errc::result_out_of_range) return value;
  return word.find("e-") != word.npos || word.find("E-") != word.npos ? 0 : std::numeric_limits<double>::infinity();
}

}  // namespace blackleaf::detail
