// Text within XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace blackleaf::detail {

/// The same text with &, <, > and " written as entities, as elements and quoted attributes want them.
inline std::string markup_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace blackleaf::detail
