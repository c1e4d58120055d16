// Files read by several processes, each some of the chunks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blackleaf/octree_file.h"

namespace blackleaf::detail {

struct Share {
  std::uint64_t number = 0, shares = 1;
};

/// As from_bytes(), but of the chunks one share only: those of all shares are all chunks, in the order of the curve,
/// each share with about as many bytes. What is not in it is white. Requires: is_shareable(); number < shares.
OctreeFile share_from_bytes(const std::vector<std::uint8_t>& bytes, const std::string& name, const Share& share,
                            const Work& work = {});

/// True iff the file is a solid of this version of the format. Throws Error(bad_input) as from_bytes.
bool is_shareable(const std::vector<std::uint8_t>& bytes, const std::string& name);

}  // namespace blackleaf::detail
