// Labels: octree files that hold many solids, one a label, and --label, which takes one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "blackleaf/label_map.h"
#include "blackleaf/octree.h"
#include "session.h"

namespace blackleaf::cli {

using Label = std::optional<std::uint32_t>;

/// Declares --label, or what else it is called.
Option* add_label(App& app, Label& target, const std::string& name = "--label",
                  const std::string& description = "of a file of many labels: the solid of this one");

/// The solid of a label. Throws Error(bad_argument) that says which there are when no voxel has it; `name` is the
/// file's.
Octree solid_of(const LabelMap& labels, std::uint32_t label, const std::string& name);

/// Loads a solid, as stage "read": of a file of labels that of `label`, or of all but 0, which a note says. Throws
/// Error(bad_argument) for a label that is not there, or of a file that has none.
Octree read_solid(Session& session, const std::string& path, const Label& label);

/// "116 labels", all but 0.
std::string counted_labels(std::size_t labels);
/// "has no labels; leave ... out" for a file of one solid.
[[noreturn]] void refuse_label(const std::string& name);

/// write_octree() for a label map. What it tells of voxels, leaves and nodes is of the solid of all labels but 0.
void write_labels(Session& session, const LabelMap& labels, const std::string& path, const std::string& source,
                  const Json& options, const Json& more = Json::object(), const std::string& before = {});

}  // namespace blackleaf::cli
