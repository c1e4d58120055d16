// blackleaf build: voxel volumes.
#include <fmt/format.h>

#include "blackleaf/move.h"
#include "blackleaf/volume_file.h"
#include "build.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

// The octree in another universe, when the two differ by a shift of whole voxels.
Octree placed_in(const Octree& octree, const Octree& universe, const std::string& input, const std::string& like) {
  const auto by = whole_shift(octree.frame(), universe.frame());
  if (!by)
    throw Error(ErrorCode::bad_input,
                fmt::format("the voxels of '{}' are not those of '{}' shifted by whole voxels", input, like),
                "leave --like out, or resample the volume");
  return translate(octree, *by).with_frame(universe.frame());
}

}  // namespace

void declare_volume_options(App& app, BuildOptions& o, Option* like) {
  const std::string volumes = "Options for volumes";
  Option* range = add_text(app, "--range", o.range, "LO:HI",
                           "values inside, ends included; either may be empty (default: any value above 0)");
  Option* label = app.add_option_function(
                         "--label", [&o](const std::string& text) { o.label = parse_number("--label", text); },
                         "exactly this value is inside (also of run streams)")
                      ->type_name("L");
  range->group(volumes)->excludes(label);
  label->group(volumes);
  add_text(app, "--series", o.series, "UID", "of a folder with several DICOM series: the UID of one, or how it ends")
      ->group(volumes);
  app.add_option_function(
         "--spacing",
         [&o](const std::string& text) {
           const Eigen::Vector3d sides = parse_vector("--spacing", text);
           o.spacing = {sides[0], sides[1], sides[2]};
         },
         "sides of a voxel in mm, for pictures, which do not tell them (default: voxels of side 1)")
      ->type_name("X,Y,Z")
      ->group(volumes);
  app.add_flag("--centre", o.centre, "centre the volume in the universe instead of placing it at the corner")
      ->group(volumes)
      ->excludes(like);
}

VolumeOptions volume_options(const Session& session, const BuildOptions& o, const std::optional<Octree>& like,
                             Json& facts) {
  VolumeOptions options;
  if (o.range) {
    const Range range = parse_range("--range", *o.range);
    options.low = range.low;
    options.high = range.high;
    facts["range"] = *o.range;
  }
  options.label = o.label;
  if (o.label) facts["label"] = *o.label;
  take_volume_options(session, o, like, facts, options);
  if (like) facts["like"] = base_name(*o.like);
  return options;
}

Octree build_volume(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  const VolumeOptions options = volume_options(session, o, like, facts);
  // The volume is built while it is read, so this is one stage.
  Octree octree = session.stage("build", [&](const Work& work) { return read_volume(o.input, options, work); });
  facts["depth"] = octree.depth();
  if (like) octree = placed_in(octree, *like, o.input, *o.like);
  return octree;
}

}  // namespace blackleaf::cli
