// blackleaf build: label maps, from volumes and run streams.
#include <fmt/format.h>

#include <cmath>

#include "blackleaf/runs_file.h"
#include "blackleaf/volume_file.h"
#include "build.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

LabelMap from_volume(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  LabelVolumeOptions options;
  if (o.bands) {
    options.bands = Bands{parse_numbers("--bands", *o.bands)};
    facts["bands"] = options.bands->thresholds;
  } else {
    facts["labels"] = true;
  }
  take_volume_options(session, o, like, facts, options);
  if (like) {
    options.frame = like->frame();
    facts["like"] = base_name(*o.like);
  }
  LabelMap labels = session.stage("build", [&](const Work& work) { return read_label_volume(o.input, options, work); });
  facts["depth"] = labels.depth();
  return labels;
}

}  // namespace

void declare_label_options(App& app, BuildOptions& o) {
  const std::string group = "Options for volumes and run streams of many labels";
  Option* labels = app.add_flag("--labels", o.labels, "keep the label of every voxel: values that are whole numbers");
  Option* bands = add_text(app, "--bands", o.bands, "LIST",
                           "volumes: keep labels 0, 1, 2, ...: how many of the thresholds a,b,... are not above "
                           "the value");
  labels->group(group);
  bands->group(group)->excludes(labels);
  for (const char* other : {"--range", "--label"}) {
    labels->excludes(app.get_option(other));
    bands->excludes(app.get_option(other));
  }
}

LabelMap build_labels(Session& session, const BuildOptions& o, const std::optional<Octree>& like, Json& facts) {
  if (suffix_of(o.input) != ".runs") return from_volume(session, o, like, facts);
  const LabelMap labels = session.stage("build", [&](const Work&) { return read_label_runs(o.input); });
  facts["labels"] = true;
  facts["depth"] = labels.depth();
  return like ? labels.with_frame(frame_for_runs(o, *like, labels.depth(), facts)) : labels;
}

}  // namespace blackleaf::cli
