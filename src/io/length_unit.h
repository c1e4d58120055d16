// Units of length in the headers of volumes and pictures.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "io/image_io.h"

namespace blackleaf::detail {

/// Millimetres in a unit of length; none for pixels and whatever else.
std::optional<double> millimetres(std::string_view unit);

/// Frames of volumes are in millimetres: scales a geometry whose header tells another unit of length, which ITK passes
/// over ("space units" or "units" of NRRD, DistanceUnits of MetaImage; it knows those of NIfTI). A unit that is told
/// but unknown is warned of and taken as millimetres. Requires: a header that check_header has passed.
void apply_units(const std::filesystem::path& path, ImageFormat format, ImageGeometry& geometry,
                 const std::function<void(const std::string&)>& warn);

}  // namespace blackleaf::detail
