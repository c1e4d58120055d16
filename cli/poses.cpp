#include "poses.h"

#include <fmt/format.h>

#include <sstream>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/path_file.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

Motion pose_in(const std::string& where, const std::string& text, const Eigen::Vector3d& about) {
  const std::size_t at = text.find('@');
  const Motion shift = Motion::translation(parse_vector(where, text.substr(0, at)));
  return at == std::string::npos ? shift : shift * parse_rotation(where, text.substr(at + 1)).about(about);
}

}  // namespace

std::vector<Motion> read_poses(Session& session, const std::string& name, const Octree& octree) {
  return session.stage("read", [&](const Work&) {
    if (name != "-") check_plain_input(name, "a file of poses");
    const std::vector<std::uint8_t> bytes = read_bytes(name);
    const std::string text(bytes.begin(), bytes.end());
    const std::string shown = name == "-" ? "standard input" : name;
    std::vector<Motion> motions;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '{') {
      const Path path = path_from_json(text, shown).path;
      for (const Pose& pose : path.poses()) motions.push_back(path.motion_at(pose.time));
      return motions;
    }
    const Eigen::Vector3d about = centroid(octree).value_or(Eigen::Vector3d::Zero());
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      line = line.substr(0, line.find('#'));
      const std::size_t begin = line.find_first_not_of(" \t\r");
      if (begin == std::string::npos) continue;
      line = line.substr(begin, line.find_last_not_of(" \t\r") - begin + 1);
      try {
        motions.push_back(pose_in(fmt::format("line {} of '{}'", number, shown), line, about));
      } catch (const Error& error) {
        throw Error(ErrorCode::bad_input, error.what());
      }
    }
    if (motions.empty())
      throw Error(ErrorCode::bad_input, fmt::format("'{}' has no poses", shown),
                  "write one a line, x,y,z or x,y,z@x,y,z:degrees");
    return motions;
  });
}

}  // namespace blackleaf::cli
