// Damage: what a decoder throws.
#pragma once

#include <string>

namespace blackleaf::detail {

/// What is wrong with the contents of a chunk, in words that follow its name. The reader makes Error(bad_input) of it.
struct Damage {
  std::string what;
};

}  // namespace blackleaf::detail
