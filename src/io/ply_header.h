// What the header of a PLY file says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "file/input_file.h"
#include "io/image_io.h"

namespace blackleaf::detail {

struct PlyProperty {
  std::string name;
  std::optional<Component> count_type;  // of a list's length; none for a single number
  std::optional<Component> type;        // none: unknown

  bool is_list() const { return count_type.has_value(); }
  /// Bytes; 0 for a single number, or an unknown type.
  unsigned count_size() const { return count_type ? static_cast<unsigned>(bytes_of(*count_type)) : 0; }
  unsigned size() const { return type ? static_cast<unsigned>(bytes_of(*type)) : 0; }
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
  std::uint64_t end = 0;  // where the data begin
  bool known = true;      // all types are
};

/// None for files that do not begin with "ply". Throws Error(bad_input) for headers that have no end or no good counts.
/// The counts are not to be trusted. Requires: file.is_regular().
std::optional<PlyHeader> read_ply_header(const InputFile& file, const std::string& name);

/// Throws Error(bad_input) if the `left` bytes behind the elements of a binary file hold one more of the last element;
/// a list in it counts as one of three, a triangle. Fewer are padding and do no harm.
void check_ply_end(const PlyHeader& header, std::uint64_t left, const std::string& name);

}  // namespace blackleaf::detail
