// Small files of JSON, such as lists of views and paths: read whole, with errors of one line.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace blackleaf::detail {

/// Text fit for a message: no line breaks, not too long.
std::string one_line(std::string_view text);
/// A value as a message shows it.
std::string shown(const nlohmann::json& value);

/// All of an ordinary file of at most 64 MB; `what` it should be is for the message, e.g. "a list of views". Throws
/// Error(io) and Error(bad_input).
std::string text_of(const std::filesystem::path& path, const std::string& what);
/// Throws Error(bad_input) that names the line. Nesting beyond 64 levels is refused.
nlohmann::json parse_json(const std::string& text, const std::string& name);
/// Throws the error that parsers throw when text is not of its format.
[[noreturn]] void refuse_text(const std::string& name, const char* format, std::size_t line, std::string_view why);

}  // namespace blackleaf::detail
