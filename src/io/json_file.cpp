#include "io/json_file.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"

namespace blackleaf::detail {

using Json = nlohmann::json;

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return line.size() > 200 ? line.substr(0, 200) + "..." : line;
}

std::string shown(const Json& value) { return one_line(value.dump(-1, ' ', false, Json::error_handler_t::replace)); }

std::string text_of(const std::filesystem::path& path, const std::string& what) {
  InputFile file(path);
  const std::string name = path.string();
  if (!file.is_regular()) throw Error(ErrorCode::io, name + ": is not an ordinary file", "copy it to one first");
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 26;
  if (file.size() > kLargest)
    throw Error(ErrorCode::bad_input, fmt::format("{}: has more than 64 MB, too many for {}", name, what),
                "name another file");
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  file.read_at(0, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  return text;
}

void refuse_text(const std::string& name, const char* format, std::size_t line, std::string_view why) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: is not {}: line {}: {}", name, format, line, one_line(why)),
              "mend it there");
}

Json parse_json(const std::string& text, const std::string& name) {
  try {
    // Far deeper than such files go, and shallow enough for what works by recursion.
    constexpr int kDeepest = 64;
    std::vector<std::set<std::string>> keys;  // of the objects that are open; the parser would keep the last of a kind
    return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& value) {
      if (depth > kDeepest) throw Error(ErrorCode::bad_input, name + ": is nested too deeply", "mend it");
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
        throw Error(ErrorCode::bad_input, fmt::format("{}: has {} twice in one object", name, shown(value)),
                    "keep the one that is meant");
      return true;
    });
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    std::string_view why = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 5: ..."
    if (const auto at = why.find(": "); at != std::string_view::npos) why.remove_prefix(at + 2);
    refuse_text(name, "JSON", 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n')), why);
  } catch (const Json::out_of_range&) {
    throw Error(ErrorCode::bad_input, name + ": has a number beyond floating point", "mend it");
  }
}

}  // namespace blackleaf::detail
