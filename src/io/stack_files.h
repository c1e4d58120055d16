// The files of a stack: what kind each is, and the order of their names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace blackleaf::detail {

enum class SliceKind { none, dicom, png, tiff };

/// What the file's first bytes say, whatever its name. Throws Error(io) when it cannot be read.
SliceKind slice_kind(const std::filesystem::path& path);

/// The kind that a name's suffix promises: .dcm, .dicom, .ima, .png, .tif, .tiff, in any case of letters.
SliceKind promised_kind(const std::filesystem::path& path);

/// Natural order: digits within names count as numbers, so img2 comes before img10; names that differ in leading zeros
/// alone are ordered as texts. A strict weak order.
bool natural_less(std::string_view a, std::string_view b);

/// The slices of a folder, of one kind; files in natural order.
struct StackFiles {
  SliceKind kind = SliceKind::none;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> passed_over;  // names of the other files, hidden ones left out
};

/// Looks at every file of the folder, not at folders in it. DICOM files win over pictures. Throws Error(io) when the
/// folder or a file cannot be read, Error(bad_input) when there are no slices, PNG and TIFF files together, or a file
/// whose suffix promises a slice and whose contents are none.
StackFiles find_slices(const std::filesystem::path& folder);

/// What is odd about the names of a stack of pictures, as one line: several patterns, or a number left out; empty if
/// nothing. `files` are in natural order.
std::string oddity_of_names(const std::vector<std::filesystem::path>& files);

/// "a.txt", "a.txt and b.txt", "a.txt, b.txt and 7 more".
std::string some_of(const std::vector<std::string>& names);

}  // namespace blackleaf::detail
