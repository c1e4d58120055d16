#include "io/header_text.h"

#include <zlib.h>

#include <memory>
#include <span>
#include <sstream>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"

namespace blackleaf::detail {

namespace fs = std::filesystem;

void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

std::string shown(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return "'" + result + "'";
}

std::vector<std::string_view> words(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\v\f\r\n";
  std::vector<std::string_view> result;
  for (std::size_t at = 0; (at = text.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    result.push_back(text.substr(at, end - at));
    at = end;
  }
  return result;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string head_of(const fs::path& path, std::size_t limit) {
  InputFile file(path);
  std::vector<std::uint8_t> bytes(limit);
  std::size_t size = 0;
  while (size < limit) {
    const std::size_t got = file.read_some(std::span(bytes).subspan(size));
    if (got == 0) break;
    size += got;
  }
  return {reinterpret_cast<const char*>(bytes.data()), size};
}

std::string unpacked_head_of(const fs::path& path, unsigned limit) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  std::string head(limit, '\0');
  const int got = file ? gzread(file.get(), head.data(), limit) : 0;
  head.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return head;
}

}  // namespace blackleaf::detail
