#include "path_input.h"

#include "blackleaf/error.h"
#include "blackleaf/path_file.h"
#include "files.h"

namespace blackleaf::cli {

Option* add_path_input(App& app, std::string& target) {
  return app.add_option("--path", target, "JSON file of poses over time, or - for standard input")
      ->required()
      ->type_name("PATH");
}

Path read_path_input(Session& session, const std::string& name, const std::string& octree_name) {
  if (name == "-" && octree_name == "-")
    throw Error(ErrorCode::bad_argument, "the octree and the path are both - for standard input",
                "name a file for one of them");
  return session.stage("read", [&](const Work&) {
    if (name != "-") {
      check_plain_input(name, "a path");
      return read_path(name).path;
    }
    const std::vector<std::uint8_t> bytes = read_bytes(name);
    return path_from_json({bytes.begin(), bytes.end()}, "standard input").path;
  });
}

}  // namespace blackleaf::cli
