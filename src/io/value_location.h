// ValueLocation: where a volume file keeps its values, and how, as far as its header tells it simply.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/image_io.h"

namespace blackleaf::detail {

enum class Packing { raw, compressed, text, hex, other };  // compressed: gzip or zlib

struct ValueLocation {
  /// False: several data files, lines to be skipped, a packing of its own. Then only the format's library finds the
  /// values.
  bool direct = true;
  Packing packing = Packing::raw;
  bool known = true;            // false: several data files; nothing is claimed of their length
  std::filesystem::path file;   // where the values are,
  std::uint64_t offset = 0;     // from here on,
  std::uint64_t available = 0;  // in so many bytes at most
  std::uint64_t before = 0;     // other bytes ahead of the values, once unpacked
  bool at_end = false;          // the values are the last of these bytes, not the first
  bool swapped = false;         // their byte order is not this machine's
  /// The type in the file, where the format scales its values; then a value is slope * stored + intercept, a double
  /// unless that changes nothing.
  std::optional<Component> stored;
  double slope = 1, intercept = 0;
  bool scaled() const { return slope != 1 || intercept != 0; }
};

/// Throws Error(bad_input) for a header that makes no sense in this, or that names a data file that cannot be read.
ValueLocation locate_values(const std::filesystem::path& path, ImageFormat format);

}  // namespace blackleaf::detail
