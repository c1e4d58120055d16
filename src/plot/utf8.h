// UTF-8 as formats want it.
#pragma once

#include <string>
#include <string_view>

namespace blackleaf::detail {

/// The same text where it is UTF-8 (RFC 3629), and '?' for every byte that is part of nothing: names of files may hold
/// any bytes, XML and JSON may not.
std::string valid_utf8(std::string_view text);

}  // namespace blackleaf::detail
