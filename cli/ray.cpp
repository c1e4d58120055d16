// blackleaf ray: where a ray enters and leaves a solid.
#include "blackleaf/ray.h"

#include <fmt/format.h>

#include "commands.h"
#include "files.h"
#include "labels.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

// The face that a point is on: "face -x" is the one whose outward normal is -x.
std::string face(const RayPoint& point) {
  for (Eigen::Index i = 0; i < 3; ++i)
    if (point.normal[i] != 0) return fmt::format("{}{}", point.normal[i] < 0 ? '-' : '+', "xyz"[i]);
  return "";
}

Json as_json(const RayPoint& point) {
  const std::string name = face(point);
  return {{"time", point.time},
          {"point", {point.point.x(), point.point.y(), point.point.z()}},
          {"face", name.empty() ? Json() : Json(name)}};
}

std::string as_text(const RayPoint& point) {
  const std::string name = face(point);
  return fmt::format("({:.10g}, {:.10g}, {:.10g}) at {:.10g}{}", point.point.x(), point.point.y(), point.point.z(),
                     point.time, name.empty() ? "" : ", face " + name);
}

}  // namespace

int run_ray(Session& session) {
  std::string name, origin, direction;
  Label label;
  bool all = false;
  add_octree_input(session.app(), "FILE", name);
  session.app().add_option("--from", origin, "where the ray begins, in voxels")->required()->type_name("x,y,z");
  session.app()
      .add_option("--direction", direction, "where it goes; times are in units of its length")
      ->required()
      ->type_name("x,y,z");
  session.app().add_flag("--all", all, "every stretch in the solid, not only the first hit");
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf ray bunny.octree --from 0,128,128 --direction 1,0,0");
  if (!session.parse()) return kDone;

  const Ray ray{parse_vector("--from", origin), parse_vector("--direction", direction)};
  const Octree octree = read_solid(session, name, label);
  std::vector<RayStretch> stretches;
  session.stage("ray", [&](const Work&) {
    if (all)
      stretches = crossings(octree, ray);
    else if (const auto hit = first_hit(octree, ray))
      stretches.push_back({*hit, {}});
  });
  if (session.json()) {
    Json report = {{"hit", !stretches.empty()}};
    if (all) {
      report["stretches"] = Json::array();
      for (const auto& [enter, leave] : stretches)
        report["stretches"].push_back({{"enter", as_json(enter)}, {"leave", as_json(leave)}});
    } else if (!stretches.empty()) {
      report.update(as_json(stretches.front().enter));
    }
    print_out(report);
  } else if (!session.quiet()) {
    std::string text;
    for (const auto& [enter, leave] : stretches)
      text += all ? fmt::format("from {}\n  to {}\n", as_text(enter), as_text(leave))
                  : fmt::format("it hits at {}\n", as_text(enter));
    print_out(text.empty() ? "it misses\n" : text);
  }
  return stretches.empty() ? kNo : kDone;
}

}  // namespace blackleaf::cli
