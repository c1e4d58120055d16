// --poses: many poses of one solid.
#pragma once

#include <string>
#include <vector>

#include "blackleaf/motion.h"
#include "blackleaf/octree.h"
#include "session.h"

namespace blackleaf::cli {

/// The motions in a file, or on standard input for "-", as stage "read": the poses of a path in JSON, or text with one
/// pose a line, x,y,z or x,y,z@x,y,z:degrees, which turns the solid about its centroid and then shifts it; empty lines
/// and what follows a # are passed over. Throws Error(io), and Error(bad_input) that names the line.
std::vector<Motion> read_poses(Session& session, const std::string& name, const Octree& octree);

}  // namespace blackleaf::cli
