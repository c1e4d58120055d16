// Stacks of slices: DICOM series, and PNG and TIFF pictures lying one behind the other.
#pragma once

#include <filesystem>
#include <memory>

#include "io/volume_source.h"

namespace blackleaf::detail {

/// True iff the suffix is one of DICOM, TIFF or PNG files.
bool has_slice_suffix(const std::filesystem::path& path);
/// True iff the path is a folder, or begins as a DICOM, PNG or TIFF file does and has no suffix of another volume;
/// false for what cannot be read.
bool is_stack(const std::filesystem::path& path);

/// The slices of a folder or of one file, in order: docs/VOLUMES.md says which files count, how they are ordered and
/// where their geometry comes from. Slices are decoded in a process of their own, since files are not trusted, one at a
/// time. Throws Error(io) when something cannot be read, Error(bad_input) when the slices do not make a volume or are
/// damaged, Error(bad_argument) for options that do not apply. O(slices) for headers; the values are read by read().
std::unique_ptr<VolumeSource> open_stack(const std::filesystem::path& path, const SourceOptions& options);

}  // namespace blackleaf::detail
