// Silhouettes from files: pictures and where they were taken from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "blackleaf/silhouettes.h"

namespace blackleaf {

/// What a views file says.
struct SilhouetteSet {
  int depth = 0;  // the file's own, or that which was asked for in its place, or the smallest with a voxel a pixel
  std::vector<Silhouette> silhouettes;
};

/// Reads a JSON file (.json) or TOML file (.toml, any other suffix is read as JSON) of this form and the PNG images
/// that it names, relative to its own folder:
///
///     {"depth": 7, "views": [{"image": "front.png", "view": [0,-1,0], "up": [0,0,1], "pixel_size": 1.0}, ...]}
///
/// `view` is a direction toward the viewer or one of "front" (0,-1,0), "back" (0,1,0), "right" (1,0,0), "left"
/// (-1,0,0), "top" (0,0,1), "bottom" (0,0,-1); the first three views without one are front, right and top. `up`,
/// `pixel_size` (in voxels of the file's depth) and `depth` may be left out; see Silhouette for what holds then. A view
/// may be only an image's name instead of an object. With `depth` (1 to 20), that is the depth; pixel sizes then keep
/// their proportion to the universe, if the file has a depth. Throws Error(io) when the file or an image cannot be
/// read, Error(bad_input) for what is no JSON, TOML or PNG, for unknown, missing or wrong entries: the message names
/// the file and the entry.
SilhouetteSet read_silhouettes(const std::filesystem::path& path, std::optional<int> depth = {});

/// Reads one PNG image into width, height and pixels; the rest is left as it is. Where the image has an alpha channel
/// that is not opaque throughout, what is at least half opaque is object, else what is brighter than half, by the
/// values in the file: gamma and colour profiles are not applied. Throws as above; images of 2^28 pixels or more are
/// refused.
void read_silhouette_image(const std::filesystem::path& path, Silhouette& silhouette);

/// A PNG image of the silhouette's pixels, white where there is object and black elsewhere; read_silhouette_image()
/// gives the same pixels back. Requires: as many pixels as width x height, one at least.
std::vector<std::uint8_t> to_png(const Silhouette& silhouette);

}  // namespace blackleaf
