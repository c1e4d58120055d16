// The contents of version 2, labels: a stretch of a labelled stream.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "blackleaf/runs.h"

namespace blackleaf::detail {

/// The bytes of a chunk with these runs: neighbours have different labels, no count is 0, at least two runs.
std::vector<std::uint8_t> encode_labels(std::span<const Run> runs);

/// Calls visit(count, label) for the runs that the bytes of a chunk of so many voxels stand for. Throws Damage for
/// bytes that encode_labels cannot have made.
void decode_labels(std::span<const std::uint8_t> bytes, std::uint64_t voxels,
                   const std::function<void(std::uint64_t count, std::uint32_t label)>& visit);

}  // namespace blackleaf::detail
