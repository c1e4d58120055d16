// --path: the path of a moving solid, as `sweep` and `animate` share it.
#pragma once

#include <string>

#include "blackleaf/path.h"
#include "session.h"

namespace blackleaf::cli {

/// Declares the required --path.
Option* add_path_input(App& app, std::string& target);

/// Reads the path, from standard input for "-", as stage "read". `octree_name` is the other input: both cannot be "-".
Path read_path_input(Session& session, const std::string& name, const std::string& octree_name);

}  // namespace blackleaf::cli
