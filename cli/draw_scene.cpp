#include "draw_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "blackleaf/align.h"
#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/path.h"
#include "blackleaf/sweep.h"
#include "files.h"
#include "path_input.h"

namespace blackleaf::cli {
namespace {

constexpr int kMostSteps = 1000;
constexpr int kUsualSteps = 5;

std::string quoted(const std::string& name) { return name == "-" ? "standard input" : "'" + name + "'"; }

// Throws unless two solids are of one universe.
void require_one_universe(const Octree& first, const std::string& first_name, const Octree& other,
                          const std::string& name) {
  const char* remedy = "build both in one universe, with build --like, or place them by their frames with --align";
  if (first.depth() != other.depth())
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} has depth {} and {} has depth {}", quoted(first_name), first.depth(), quoted(name),
                            other.depth()),
                remedy);
  if (!first.frame().same_as(other.frame()))
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} and {} have different frames", quoted(first_name), quoted(name)), remedy);
}

void require_one_lattice(const Octree& first, const std::string& first_name, const Octree& other,
                         const std::string& name) {
  if (!whole_shift(other.frame(), first.frame()))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--align: the voxels of {} do not lie on those of {} in the world", quoted(name),
                            quoted(first_name)),
                "build it with the other's frame, with build --like");
}

// The solid at steps of its way, evenly in time.
std::vector<Octree> on_its_way(Session& session, const Octree& solid, const Path& path, int steps, Leaving leaving) {
  std::vector<Motion> motions;
  for (int i = 0; i < steps; ++i) {
    const double part = steps == 1 ? 0 : static_cast<double>(i) / (steps - 1);
    motions.push_back(
        path.motion_at(i + 1 == steps && steps > 1 ? path.end() : path.begin() + part * (path.end() - path.begin())));
  }
  return session.stage("move", [&](const Work& work) {
    const RoomForMotions room = room_for(solid, motions, leaving, work);
    std::vector<Octree> places;
    places.reserve(motions.size());
    for (const Motion& motion : room.motions) places.push_back(move(room.octree, motion, leaving, {work.threads, {}}));
    return places;
  });
}

// Above zero if the viewer is above the plane x_axis = at, below zero below it.
double side_of_viewer(const View& view, std::size_t axis, std::int32_t at) {
  if (view.eye_point()) return view.eye_point()->eye[static_cast<Eigen::Index>(axis)] - at;
  return static_cast<double>(view.direction()[axis]);
}

}  // namespace

void SceneArguments::add_to(App& app) {
  app.add_option("FILE", files_, "octree files of one universe, or - for standard input")->required()->type_name("");
  add_label(app, label_);
  app.add_flag("--align", align_, "place all files by their frames, in the universe of the first, doubled as needed");
  app.add_option(
         "--cut", cuts_,
         "cut open: take away what lies before the plane x=64, towards the viewer; x=64,y=32 takes only what lies "
         "before both; repeatable")
      ->type_name("x=N[,y=N][,z=N]")
      ->expected(1)
      ->repeatable();
  add_text(app, "--path", path_, "PATH", "draw the first file at steps along this path, beside the others");
  add_integer(
      app, "--steps", steps_, 1, kMostSteps,
      fmt::format("of --path: so many steps, evenly from the first pose to the last (default {})", kUsualSteps));
  leaving_.add_to(app);
}

SceneArguments::Planes SceneArguments::parse_cut(const std::string& text) {
  const auto refuse = [&] {
    throw Error(ErrorCode::bad_argument, fmt::format("--cut is '{}', which is no plane", text),
                "write it like x=64, or x=64,y=32 for the part before both");
  };
  Planes planes;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    if (part.size() < 3 || part[1] != '=' || part[0] < 'x' || part[0] > 'z') refuse();
    std::optional<std::int32_t>& plane = planes[static_cast<std::size_t>(part[0] - 'x')];
    if (plane) refuse();
    plane = static_cast<std::int32_t>(parse_integer("--cut", part.substr(2), 0, std::int64_t{1} << kMaxDepth));
    at = end + 1;
  }
  return planes;
}

void SceneArguments::check() const {
  for (const std::string& cut : cuts_) static_cast<void>(parse_cut(cut));
  if (std::count(files_.begin(), files_.end(), "-") > 1)
    throw Error(ErrorCode::bad_argument, "more than one octree is - for standard input", "name files for the others");
  if (!path_ && (steps_ || leaving_.choice() != Leaving::error))
    throw Error(ErrorCode::bad_argument, fmt::format("--{} belongs to --path", steps_ ? "steps" : leaving_.name()),
                "add --path or leave it out");
}

void SceneArguments::require_faced(const View& view) const {
  for (const std::string& text : cuts_) {
    const Planes planes = parse_cut(text);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (planes[axis] && side_of_viewer(view, axis, *planes[axis]) == 0)
        throw Error(ErrorCode::bad_argument,
                    fmt::format("--cut {}: --{} sees the plane edge-on", text, view.eye_point() ? "eye" : "view"),
                    "turn the view, or cut across another axis");
  }
}

std::string SceneArguments::source() const {
  std::string names;
  for (const std::string& file : files_) names += (names.empty() ? "" : ", ") + base_name(file);
  return names;
}

NamedScene SceneArguments::read(Session& session) const {
  std::vector<Octree> octrees;
  std::vector<NamedScene::Solid> solids;
  bool labelled = false;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::string& name = files_[i];
    OctreeFile file = read_octree(session, name);
    labelled = labelled || file.labels;
    if (label_ && files_.size() == 1 && !file.labels) refuse_label(name);
    const bool one = !file.labels || label_ || (path_ && i == 0);
    if (one) {
      if (file.labels && label_)
        file.octree = session.stage("read", [&](const Work&) { return solid_of(*file.labels, *label_, name); });
      octrees.push_back(std::move(file.octree));
      solids.push_back({base_name(name), i, std::nullopt});
    } else {
      auto parts = session.stage("read", [&](const Work& work) { return solids_of_labels(*file.labels, work); });
      for (LabelledSolid& part : parts) {
        octrees.push_back(std::move(part.octree));
        const std::string label = fmt::format("label {}", part.label);
        solids.push_back({files_.size() == 1 ? label : base_name(name) + " " + label, i, part.label});
      }
      if (parts.empty()) {
        octrees.push_back(std::move(file.octree));
        solids.push_back({base_name(name), i, std::nullopt});
      }
    }
    const Octree& last = octrees.back();
    if (align_)
      require_one_lattice(octrees.front(), files_.front(), last, name);
    else
      require_one_universe(octrees.front(), files_.front(), last, name);
  }
  if (label_ && !labelled)
    throw Error(ErrorCode::bad_argument, "--label is given and no file has labels", "leave it out");
  bool apart = align_;
  if (path_) {
    const Path path = read_path_input(session, *path_, files_.front());
    const int steps = steps_.value_or(kUsualSteps);
    std::vector<Octree> places = on_its_way(session, octrees.front(), path, steps, leaving_.choice());
    apart = apart || places.front().depth() != octrees.front().depth();
    octrees.erase(octrees.begin());
    octrees.insert(octrees.begin(), places.begin(), places.end());
    std::vector<NamedScene::Solid> named;
    named.reserve(static_cast<std::size_t>(steps) + solids.size());
    for (int i = 0; i < steps; ++i)
      named.push_back({fmt::format("{} step {}", solids.front().name, i + 1), 0, std::nullopt});
    named.insert(named.end(), solids.begin() + 1, solids.end());
    solids = std::move(named);
  }
  if (apart) octrees = session.stage("align", [&](const Work& work) { return aligned(octrees, work); });
  if (solids.size() == 1) solids.front().name.clear();
  Scene scene = session.stage("unite", [&](const Work& work) { return Scene(std::move(octrees), work); });
  return {std::move(scene), std::move(solids)};
}

Scene SceneArguments::seen_from(const Scene& scene, const View& view, bool& cut, const Work& work) const {
  const std::int32_t side = scene.all().side();
  std::vector<Box> removed;
  for (const std::string& text : cuts_) {
    const Planes planes = parse_cut(text);
    Box box{{0, 0, 0}, {side, side, side}};
    bool edge_on = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!planes[axis]) continue;
      const double side_of = side_of_viewer(view, axis, *planes[axis]);
      edge_on = edge_on || side_of == 0;
      const std::int32_t at = std::min(*planes[axis], side);
      (side_of > 0 ? box.min : box.max)[axis] = at;
    }
    if (!edge_on) removed.push_back(box);
  }
  cut = !removed.empty();
  return removed.empty() ? scene : scene.without(removed, work);
}

}  // namespace blackleaf::cli
