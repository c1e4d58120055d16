// From the values of a volume to its octree: what read_volume() does once the volume is open, for those who open it in
// another way.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "blackleaf/octree.h"
#include "blackleaf/volume_file.h"
#include "blackleaf/work.h"
#include "io/nan_count.h"
#include "io/volume_shape.h"
#include "io/volume_source.h"

namespace blackleaf::detail {

/// Throws Error(bad_argument) for options that contradict each other or make no sense.
void check_options(const VolumeOptions& options);

/// The octree of all of a source's values, which lie where `placed` says; NaN are added to `nan`. While some slices are
/// built from, the next are read, by another thread if there is one. Of the options the range or label is used. Throws
/// as read_volume. Requires: check_options() has passed; the volume fits.
Octree octree_of(VolumeSource& source, const std::filesystem::path& path, const PlacedVolume& placed,
                 const VolumeOptions& options, NanCount& nan, const Work& work);

/// After the last value of a volume: throws Error(bad_input) if all were NaN, warns of some.
void tell_nan(const NanCount& nan, Component component, const std::filesystem::path& path,
              const std::function<void(const std::string&)>& warn);

}  // namespace blackleaf::detail
