#include "blackleaf/path_file.h"

#include <array>
#include <cassert>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/atomic_write.h"
#include "io/json_file.h"

namespace blackleaf {
namespace {

using Json = nlohmann::json;
using detail::one_line;
using detail::shown;

// Reads the entries of one file; every error names the file and the entry.
class PathReader {
 public:
  explicit PathReader(std::string name) : name_(std::move(name)) {}

  PathFile read(const std::string& text) const {
    const Json file = detail::parse_json(text, name_);
    if (!file.is_object())
      fail("the file", "is no table of entries", R"(begin with {"about": [x,y,z], "poses": [...]})");
    const char* const form = R"(write "poses": [{"time": 0, "translation": [0,0,0], "rotation": [1,0,0,0]}, ...])";
    if (!file.contains("poses")) fail("poses", "is missing", form);
    const Json& entries = file["poses"];
    if (!entries.is_array() || entries.empty()) fail("poses", "is no list of poses", form);
    std::vector<Pose> poses;
    PathNotes notes;
    bool turns = false;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      poses.push_back(pose(entries[i], fmt::format("poses[{}]", i), notes));
      turns = turns || !poses.back().rotation.vec().isZero(0);
    }
    if (!notes.clearance.empty() && notes.clearance.size() != poses.size())
      fail("poses", "have a clearance here and there only", "give all of them one, or none");
    Eigen::Vector3d about = Eigen::Vector3d::Zero();
    if (file.contains("about"))
      about = numbers<3>(file["about"], "about", "give the point that rotations leave in place, like [32,32,32]");
    else if (turns)
      fail("about", "is missing, though poses turn",
           R"(add "about": [x,y,z], the point that rotations leave in place)");
    read_notes(file, notes);
    try {
      return {Path(std::move(poses), about), std::move(notes)};
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name_, error.what()));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& entry, const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {} {}", name_, entry, what), remedy);
  }

  double number(const Json& value, const std::string& entry) const {
    if (!value.is_number()) fail(entry, "is " + shown(value), "give a number");
    return value.get<double>();
  }

  template <int kCount>
  Eigen::Matrix<double, kCount, 1> numbers(const Json& value, const std::string& entry, const char* remedy) const {
    if (!value.is_array() || value.size() != kCount) fail(entry, "is " + shown(value), remedy);
    Eigen::Matrix<double, kCount, 1> result;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!value[i].is_number()) fail(entry, "is " + shown(value), remedy);
      result[static_cast<Eigen::Index>(i)] = value[i].get<double>();
    }
    return result;
  }

  Pose pose(const Json& value, const std::string& entry, PathNotes& notes) const {
    if (!value.is_object())
      fail(entry, "is " + shown(value), R"(write {"time": 0, "translation": [0,0,0], "rotation": [1,0,0,0]})");
    Pose result;
    if (!value.contains("time")) fail(entry + ".time", "is missing", "say when the solid is there, in seconds");
    for (const auto& [key, item] : value.items()) {
      const std::string where = entry + "." + one_line(key);
      if (key == "time") {
        result.time = number(item, where);
      } else if (key == "translation") {
        result.translation = numbers<3>(item, where, "give three numbers of voxels, like [10,0,-4.5]");
      } else if (key == "rotation") {
        const Eigen::Vector4d q = numbers<4>(item, where, "give a quaternion w,x,y,z, like [1,0,0,0]");
        result.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
      } else if (key == "clearance") {
        notes.clearance.push_back(number(item, where));
      } else {
        fail(where, "is unknown", "use time, translation, rotation, clearance");
      }
    }
    return result;
  }

  void read_notes(const Json& file, PathNotes& notes) const {
    if (file.contains("length")) notes.length = number(file["length"], "length");
    if (file.contains("seconds")) notes.seconds = number(file["seconds"], "seconds");
    if (file.contains("planner")) {
      if (!file["planner"].is_string()) fail("planner", "is " + shown(file["planner"]), "give its name");
      notes.planner = file["planner"].get<std::string>();
    }
    if (file.contains("verified")) {
      if (!file["verified"].is_boolean()) fail("verified", "is " + shown(file["verified"]), "say true or false");
      notes.verified = file["verified"].get<bool>();
    }
  }

  const std::string name_;
};

// "{}" writes the shortest text that gives the same double back; adding 0 turns -0 into 0.
std::string listed(const Eigen::Vector3d& v) { return fmt::format("[{}, {}, {}]", v[0] + 0, v[1] + 0, v[2] + 0); }

}  // namespace

PathFile path_from_json(const std::string& text, const std::string& name) { return PathReader(name).read(text); }

PathFile read_path(const std::filesystem::path& file) {
  return path_from_json(detail::text_of(file, "a path"), file.string());
}

std::string to_json(const Path& path, const PathNotes& notes) {
  assert(notes.clearance.empty() || notes.clearance.size() == path.poses().size());
  std::string text = fmt::format("{{\"about\": {},\n\"poses\": [", listed(path.about()));
  for (std::size_t i = 0; i < path.poses().size(); ++i) {
    const Pose& pose = path.poses()[i];
    const Eigen::Quaterniond& q = pose.rotation;
    text += fmt::format("{}\n{{\"time\": {}, \"translation\": {}, \"rotation\": [{}, {}, {}, {}]", i > 0 ? "," : "",
                        pose.time + 0, listed(pose.translation), q.w() + 0, q.x() + 0, q.y() + 0, q.z() + 0);
    if (!notes.clearance.empty()) text += fmt::format(", \"clearance\": {}", notes.clearance[i]);
    text += "}";
  }
  text += "]";
  if (notes.length) text += fmt::format(",\n\"length\": {}", *notes.length);
  if (notes.planner)
    text += ",\n\"planner\": " + Json(*notes.planner).dump(-1, ' ', false, Json::error_handler_t::replace);
  if (notes.seconds) text += fmt::format(",\n\"seconds\": {}", *notes.seconds);
  if (notes.verified) text += fmt::format(",\n\"verified\": {}", *notes.verified);
  return text + "}\n";
}

void write_path(const Path& path, const std::filesystem::path& file, const PathNotes& notes) {
  detail::write_atomically(file, to_json(path, notes));
}

}  // namespace blackleaf
