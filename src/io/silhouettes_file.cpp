#include "blackleaf/silhouettes_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/json_file.h"
#include "octree/whole_direction.h"

namespace blackleaf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using detail::one_line;
using detail::shown;

Json from_toml(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    Json object = Json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = from_toml(value);
    return object;
  }
  if (const auto* array = node.as_array()) {
    Json list = Json::array();
    for (const toml::node& item : *array) list.push_back(from_toml(item));
    return list;
  }
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto number = node.value_exact<std::int64_t>()) return *number;
  if (const auto number = node.value_exact<double>()) return *number;
  if (const auto truth = node.value_exact<bool>()) return *truth;
  return nullptr;  // dates and times, which are wrong wherever they stand
}

Json parse(const std::string& text, const fs::path& path) {
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix != ".toml") return detail::parse_json(text, path.string());
  try {
    return from_toml(toml::parse(text, path.string()));
  } catch (const toml::parse_error& error) {
    detail::refuse_text(path.string(), "TOML", error.source().begin.line, error.description());
  }
}

// Reads the entries of one file; every error names the file and the entry.
class ViewsReader {
 public:
  explicit ViewsReader(const fs::path& path) : path_(path) {}

  SilhouetteSet read(std::optional<int> depth) {
    const Json file = parse(detail::text_of(path_, "a list of views"), path_);
    if (!file.is_object()) fail("the file", "is no table of entries", R"(begin with {"views": [...]})");
    refuse_unknown(file, "", {"depth", "views"});
    SilhouetteSet set;
    const int own = file.contains("depth") ? whole_depth(file["depth"]) : 0;
    if (!file.contains("views")) fail("views", "is missing", R"(add "views": [{"image": "front.png"}, ...])");
    const Json& views = file["views"];
    if (!views.is_array() || views.empty())
      fail("views", "is no list of views", R"(write "views": [{"image": "front.png"}, ...])");
    std::size_t unnamed = 0;
    for (std::size_t i = 0; i < views.size(); ++i) set.silhouettes.push_back(view(views[i], i, unnamed));
    set.depth = depth ? *depth : own > 0 ? own : depth_of(set.silhouettes);
    if (depth && own > 0)
      for (Silhouette& s : set.silhouettes)
        if (s.pixel_size) s.pixel_size = std::ldexp(*s.pixel_size, *depth - own);
    return set;
  }

 private:
  [[noreturn]] void fail(const std::string& entry, const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {} {}", path_.string(), entry, what), remedy);
  }

  void refuse_unknown(const Json& object, const std::string& where, std::initializer_list<const char*> known) const {
    for (const auto& [key, value] : object.items())
      if (std::none_of(known.begin(), known.end(), [&k = key](const char* name) { return k == name; }))
        fail(where + one_line(key), "is unknown", fmt::format("use {}", fmt::join(known, ", ")));
  }

  int whole_depth(const Json& value) const {
    if (!value.is_number_integer() || value < 1 || value > kMaxDepth)
      fail("depth", "is " + shown(value), "use a whole number from 1 to 20");
    return value.get<int>();
  }

  Silhouette view(const Json& value, std::size_t index, std::size_t& unnamed) const {
    const std::string where = fmt::format("views[{}]", index);
    const Json entry = value.is_string() ? Json{{"image", value}} : value;
    if (!entry.is_object()) fail(where, "is " + shown(value), R"(write {"image": "front.png", "view": [0,-1,0]})");
    refuse_unknown(entry, where + ".", {"image", "view", "up", "pixel_size"});
    Silhouette s;
    if (!entry.contains("image")) fail(where + ".image", "is missing", "name a PNG image");
    if (!entry["image"].is_string() || entry["image"].get<std::string>().empty())
      fail(where + ".image", "is " + shown(entry["image"]), "name a PNG image");
    if (entry.contains("view")) {
      s.view = named_or_vector(entry["view"], where + ".view");
    } else {
      constexpr std::array<const char*, 3> kDefaults = {"front", "right", "top"};
      if (unnamed == kDefaults.size())
        fail(where + ".view", "is missing", "only three views may go without: front, right and top");
      s.view = *named(kDefaults[unnamed++]);
    }
    if (entry.contains("up")) {
      s.up = named_or_vector(entry["up"], where + ".up");
      if (detail::parallel(s.view, *s.up))
        fail(where + ".up", "is parallel to the view", "give another direction, or leave it out");
    }
    if (entry.contains("pixel_size")) {
      const Json& size = entry["pixel_size"];
      if (!size.is_number() || !(size.get<double>() >= 0x1p-30) || !(size.get<double>() <= 0x1p30))
        fail(where + ".pixel_size", "is " + shown(size), "give the side of a pixel in voxels, from 2^-30 to 2^30");
      s.pixel_size = size.get<double>();
    }
    image(entry["image"].get<std::string>(), where, s);
    return s;
  }

  void image(const std::string& name, const std::string& where, Silhouette& s) const {
    if (name.find('\0') != std::string::npos) fail(where + ".image", "has a zero byte in it", "name a PNG image");
    const fs::path named(name);
    try {
      read_silhouette_image(named.is_absolute() ? named : path_.parent_path() / named, s);
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("{}: {}.image: {}", path_.string(), where, error.what()));
    }
  }

  static std::optional<Eigen::Vector3d> named(const std::string& name) {
    static const std::map<std::string, Eigen::Vector3d> directions = {{"front", {0, -1, 0}}, {"back", {0, 1, 0}},
                                                                      {"right", {1, 0, 0}},  {"left", {-1, 0, 0}},
                                                                      {"top", {0, 0, 1}},    {"bottom", {0, 0, -1}}};
    const auto found = directions.find(name);
    return found == directions.end() ? std::nullopt : std::optional(found->second);
  }

  Eigen::Vector3d named_or_vector(const Json& value, const std::string& where) const {
    const char* const remedy = "give three numbers like [0,-1,0], or front, back, left, right, top or bottom";
    if (value.is_string())
      if (const auto direction = named(value.get<std::string>())) return *direction;
    if (!value.is_array() || value.size() != 3) fail(where, "is " + shown(value), remedy);
    Eigen::Vector3d v;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!value[i].is_number()) fail(where, "is " + shown(value), remedy);
      v[static_cast<Eigen::Index>(i)] = value[i].get<double>();
    }
    if (!v.allFinite() || v.isZero(0)) fail(where, "is " + shown(value) + ", no direction", remedy);
    return v;
  }

  // The smallest universe with a voxel a pixel.
  static int depth_of(const std::vector<Silhouette>& silhouettes) {
    std::uint32_t largest = 2;
    for (const Silhouette& s : silhouettes)
      largest = std::max({largest, static_cast<std::uint32_t>(s.width), static_cast<std::uint32_t>(s.height)});
    return std::min(static_cast<int>(std::bit_width(largest - 1)), kMaxDepth);
  }

  const fs::path path_;
};

}  // namespace

SilhouetteSet read_silhouettes(const fs::path& path, std::optional<int> depth) {
  if (depth && (*depth < 1 || *depth > kMaxDepth))
    throw Error(ErrorCode::bad_argument, fmt::format("depth {} is out of range", *depth), "use 1 to 20");
  return ViewsReader(path).read(depth);
}

}  // namespace blackleaf
