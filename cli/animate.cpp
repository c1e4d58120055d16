// blackleaf animate: a solid on its way along a path, as a sequence of octrees or pictures.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "blackleaf/drawing.h"
#include "blackleaf/error.h"
#include "blackleaf/label_map.h"
#include "blackleaf/measures.h"
#include "blackleaf/sweep.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"
#include "path_input.h"
#include "picture_options.h"

namespace blackleaf::cli {
namespace {

constexpr int kMostFrames = 100000;

// File names with a number in them: a text with one %d or %04d, and %% for a percent sign.
class FrameNames {
 public:
  explicit FrameNames(const std::string& pattern) {
    bool numbered = false;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      std::string& part = numbered ? after_ : before_;
      if (pattern[i] != '%') {
        part += pattern[i];
        continue;
      }
      std::size_t end = pattern.find_first_not_of("0123456789", i + 1);
      if (end == i + 1 && pattern[end] == '%') {
        part += '%';
        ++i;
        continue;
      }
      const std::string digits = end == std::string::npos ? "" : pattern.substr(i + 1, end - i - 1);
      if (end == std::string::npos || pattern[end] != 'd' || numbered || digits.size() > 2) refuse(pattern);
      numbered = true;
      width_ = digits.empty() ? 1 : std::stoi(digits);
      i = end;
    }
    if (!numbered) refuse(pattern);
  }

  std::string of(int number) const { return fmt::format("{}{:0{}}{}", before_, number, width_, after_); }

 private:
  [[noreturn]] static void refuse(const std::string& pattern) {
    throw Error(ErrorCode::bad_argument,
                fmt::format("-o is '{}', which does not say once where the frame's number goes", pattern),
                "write it like frame%04d.svg");
  }

  std::string before_, after_;
  int width_ = 1;
};

// "octree", "svg", "json", "png" or "pdf".
std::string kind_of(const std::string& output) {
  const std::string suffix = suffix_of(output);
  for (const char* kind : {"octree", "svg", "json", "png", "pdf"})
    if (suffix == std::string(".") + kind) return kind;
  throw Error(ErrorCode::bad_argument,
              fmt::format("cannot write frames like '{}': unknown suffix '{}'", output, suffix),
              "use .octree, .svg, .png, .pdf or .json");
}

// When the frames are: `frames` from the path's first pose to its last, or so many a second from the first on.
std::vector<double> frame_times(const Path& path, std::optional<int> frames, std::optional<double> fps) {
  const double length = path.end() - path.begin();
  if (fps && length * *fps >= kMostFrames)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} frames a second along {} seconds are more than {}", *fps, length, kMostFrames),
                "ask for fewer");
  // A last frame that is late by rounding only is one all the same.
  const int count = frames ? *frames : static_cast<int>(std::floor(length * *fps + 1e-6)) + 1;
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const double since = fps ? i / *fps : count == 1 ? 0 : length * i / (count - 1);
    times.push_back(std::min(path.begin() + since, path.end()));
  }
  return times;
}

// The box in the picture that holds the solid in every frame: of the moved corners of its bounding box.
Eigen::AlignedBox2d common_region(const Octree& solid, const View& view, const std::vector<Motion>& motions) {
  Eigen::AlignedBox2d region;
  const std::optional<Box> box = bounding_box(solid);
  if (!box) return region;
  for (const Motion& motion : motions)
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p =
          motion(Eigen::Vector3d((corner & 1 ? box->max : box->min)[0], (corner & 2 ? box->max : box->min)[1],
                                 (corner & 4 ? box->max : box->min)[2]));
      region.extend(Eigen::Vector2d(view.right().dot(p), view.up().dot(p)));
    }
  return region;
}

}  // namespace

int run_animate(Session& session) {
  Label label;
  std::string input, path_name, output;
  std::optional<std::string> view_text;
  std::optional<int> frames;
  std::optional<double> fps;
  LeavingOptions leaving;
  PictureOptions picture;
  add_octree_input(session.app(), "FILE", input);
  add_path_input(session.app(), path_name);
  session.app()
      .add_option("-o,--output", output,
                  "files to write: .octree .svg .png .pdf .json; %04d becomes the frame's number, from 0001 on")
      ->required()
      ->type_name("OUT%04d");
  Option* count = add_integer(session.app(), "--frames", frames, 1, kMostFrames,
                              "so many frames, evenly from the first pose to the last");
  add_number(session.app(), "--fps", fps, true, "so many frames a second of the path's time")->excludes(count);
  add_text(session.app(), "--view", view_text, "x,y,z", "of pictures: direction toward the viewer");
  picture.add_to(session.app());
  leaving.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf animate bunny.octree --path hop.json -o hop%04d.png --frames 48 --view 3,-4,2");
  if (!session.parse()) return kDone;

  const FrameNames names(output);
  const std::string kind = kind_of(output);
  if (!frames && !fps)
    throw Error(ErrorCode::bad_argument, "neither --frames nor --fps is given", "say --frames 48 or --fps 25");
  if (kind == "octree" && view_text)
    throw Error(ErrorCode::bad_argument, "--view does not apply to octrees", "leave it out");
  if (kind != "octree" && !view_text)
    throw Error(ErrorCode::bad_argument, "pictures need --view", "give a direction toward the viewer like 3,-4,2");
  picture.check(kind);
  const std::optional<View> view = view_text ? std::optional(parse_view(*view_text)) : std::nullopt;
  check_output(names.of(1));

  const Path path = read_path_input(session, path_name, input);
  const std::vector<double> times = frame_times(path, frames, fps);
  // Octrees of a file of labels have all of them; a picture shows one solid.
  std::optional<LabelMap> map;
  Octree solid;
  if (kind == "octree") {
    OctreeFile file = read_octree(session, input);
    if (label && !file.labels) refuse_label(input);
    if (!label) map = file.labels;
    solid = label ? solid_of(*file.labels, *label, input) : file.octree;
  } else {
    solid = read_solid(session, input, label);
  }
  std::vector<Motion> way;
  way.reserve(times.size());
  for (const double time : times) way.push_back(path.motion_at(time));
  // All frames are asked before the first is written.
  RoomForMotions room;
  session.stage("animate", [&](const Work& work) {
    if (!map) {
      room = room_for(solid, way, leaving.choice(), work);
      return;
    }
    RoomForLabels with_labels = room_for(*map, way, leaving.choice(), work);
    map = with_labels.labels;
    room.motions = std::move(with_labels.motions);
  });
  PageOptions page;
  if (view) {
    const Eigen::AlignedBox2d region = common_region(room.octree, *view, room.motions);
    page = picture.page(region);
    if (!region.isEmpty()) page.region = region;
  }

  const auto total = static_cast<int>(times.size());
  session.stage("animate", [&](const Work& work) {
    for (int i = 0; i < total; ++i) {
      const auto part = [&](double from, double to) {
        return Work{work.threads,
                    [&, from, to](double done) { return work.progress((i + from + (to - from) * done) / total); }};
      };
      const auto index = static_cast<std::size_t>(i);
      const Motion& motion = room.motions[index];
      const std::string name = names.of(i + 1);
      if (view) {
        const Octree moved = move(room.octree, motion, leaving.choice(), part(0, 0.5));
        write_drawing(draw(moved, *view, part(0.5, 1)), name, page);
      } else {
        Json options = {{"path", base_name(path_name)}, {"time", times[index]}, {"frame", i + 1}, {"frames", total}};
        if (label) options["label"] = *label;
        const std::string metadata = metadata_text(session, input, options);
        if (map)
          save(move(*map, motion, leaving.choice(), part(0, 1)), name, metadata);
        else
          save(move(room.octree, motion, leaving.choice(), part(0, 1)), name, metadata);
      }
      set_left_behind(fmt::format("{} of {} frames were written", i + 1, total));
    }
  });
  set_left_behind({});

  if (session.json())
    print_out(Json{{"frames", total},
                   {"first", names.of(1)},
                   {"last", names.of(total)},
                   {"from", times.front()},
                   {"to", times.back()}});
  else if (!session.quiet())
    print_out(total == 1 ? fmt::format("{}: one frame\n", names.of(1))
                         : fmt::format("{} to {}: {} frames\n", names.of(1), names.of(total), grouped(times.size())));
  return kDone;
}

}  // namespace blackleaf::cli
