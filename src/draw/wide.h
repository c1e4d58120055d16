// Integers of 128 bits.
#pragma once

namespace blackleaf::detail {

__extension__ using Wide = __int128;

}  // namespace blackleaf::detail
