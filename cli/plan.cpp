// blackleaf plan: a way for a solid from one pose to another that touches nothing.
#include "blackleaf/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/path_file.h"
#include "commands.h"
#include "files.h"
#include "options.h"
#include "plan_scene.h"

namespace blackleaf::cli {
namespace {

// What is typed.
struct Request {
  std::string environment;
  std::vector<std::string> objects, starts, goals, outputs, resampled;
  std::vector<std::string> moving, along;  // octrees and their paths
  std::optional<std::string> planner;
  std::optional<double> seconds, clearance, preferred_clearance, speed, range;
  std::optional<int> seed, refinement;
  bool as_found = false;
  Label environment_label, object_label;
};

void declare(App& app, Request& request) {
  const auto text = [&](const char* name, std::vector<std::string>& target, const char* type, const char* description) {
    return app.add_option(name, target, description)->required()->type_name(type)->allow_extra_args(false);
  };
  app.add_option("--environment", request.environment, "octree file of what stands still, or - for standard input")
      ->required()
      ->type_name("FILE");
  text("--object", request.objects, "FILE",
       "octree file of what is to move; repeatable, with a --start, a --goal and an -o each: the first has the way, "
       "later ones give way");
  text("--start", request.starts, "POSE", "where it starts: x,y,z or x,y,z@x,y,z:degrees, turned about its centroid");
  text("--goal", request.goals, "POSE", "where it is to go, likewise");
  text("-o,--output", request.outputs, "OUT", "JSON file of the path, or - for standard output");
  app.add_option("--moving", request.moving,
                 "octree file of something that moves and is to be given way; repeatable, with an --along each")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--along", request.along, "JSON file of the path that it moves along")
      ->type_name("PATH")
      ->allow_extra_args(false);
  add_text(app, "--planner", request.planner, "NAME", "rrt-connect (default), rrt-star, prm-star, kpiece or bit-star");
  add_number(app, "--time-limit", request.seconds, true, "most seconds to look for a way, of each object (default 60)");
  add_integer(app, "--seed", request.seed, 0, std::numeric_limits<int>::max() - 1,
              "the same seed gives the same path (default 1)");
  add_number(app, "--clearance", request.clearance, false,
             "voxels that stay free all around; negative: parts may overlap so deep, to slide along walls (default 0)");
  add_number(app, "--prefer-clearance", request.preferred_clearance, true,
             "voxels that stay free where they can: what is nearer costs more than its length");
  add_integer(app, "--refine", request.refinement, 0, 100'000'000,
              "rounds that rrt-star, prm-star and bit-star take after they have found a way (default 500)");
  add_number(app, "--range", request.range, true,
             "voxels of the longest motion that rrt-connect, rrt-star and kpiece try (default: a third of the object's "
             "radius, and a 32nd of the universe's side at least)");
  add_number(app, "--speed", request.speed, true, "voxels a second that any point travels at most (default 1)");
  app.add_flag("--as-found", request.as_found,
               "leave the way as the planner finds it: no short cuts, no rounded corners");
  app.add_option("--resample", request.resampled,
                 "where an object's voxels are of another size: take its solid in those of the environment, and write "
                 "that to this octree file, for the path is its; repeatable, one for each such object")
      ->type_name("OUT")
      ->allow_extra_args(false);
  add_label(app, request.environment_label, "--label-environment",
            "of an environment of many labels: the solid of this one");
  add_label(app, request.object_label, "--label-object", "the same of the objects");
}

void check(const Session& session, const Request& request) {
  const std::size_t count = request.objects.size();
  const auto each = [&](const char* name, std::size_t given) {
    if (given != count)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("there are {} but {}", counted(count, "--object"), counted(given, name)),
                  "give one for each object, in the same order");
  };
  each("--start", request.starts.size());
  each("--goal", request.goals.size());
  each("-o", request.outputs.size());
  for (const std::string& output : request.outputs) {
    if (output == "-") {
      if (count > 1 || session.json())
        throw Error(ErrorCode::bad_argument, "-o - wants standard output for itself", "write the path to a file");
      continue;
    }
    if (suffix_of(output) != ".json")
      throw Error(ErrorCode::bad_argument, fmt::format("'{}' would be a path, which is JSON", output),
                  "name it *.json");
    check_output(output);
  }
  for (const std::string& output : request.resampled) check_octree_output(session, output);
  std::vector<std::string> outputs = request.outputs;
  outputs.insert(outputs.end(), request.resampled.begin(), request.resampled.end());
  std::sort(outputs.begin(), outputs.end());
  if (const auto same = std::adjacent_find(outputs.begin(), outputs.end()); same != outputs.end())
    throw Error(ErrorCode::bad_argument, fmt::format("'{}' is to be written twice", *same),
                "give each a name of its own");
  std::vector<std::string> inputs = request.objects;
  inputs.push_back(request.environment);
  if (request.moving.size() != request.along.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("there are {} but {}", counted(request.moving.size(), "--moving"),
                            counted(request.along.size(), "--along")),
                "give a path for each, in the same order");
  inputs.insert(inputs.end(), request.moving.begin(), request.moving.end());
  inputs.insert(inputs.end(), request.along.begin(), request.along.end());
  if (std::count(inputs.begin(), inputs.end(), "-") > 1)
    throw Error(ErrorCode::bad_argument, "two inputs are - for standard input", "name files for all but one of them");
}

PlanOptions options_of(const Request& request) {
  PlanOptions options;
  if (request.planner) {
    const auto planner = planner_of(*request.planner);
    if (!planner)
      throw Error(ErrorCode::bad_argument, fmt::format("--planner is '{}', which is no planner", *request.planner),
                  "use rrt-connect, rrt-star, prm-star, kpiece or bit-star");
    options.planner = *planner;
  }
  options.seconds = request.seconds.value_or(options.seconds);
  options.seed = static_cast<std::uint32_t>(request.seed.value_or(1));
  options.clearance = request.clearance.value_or(0);
  options.preferred_clearance = request.preferred_clearance.value_or(0);
  options.refinement = request.refinement.value_or(options.refinement);
  options.speed = request.speed.value_or(options.speed);
  options.range = request.range.value_or(0);
  options.shorten = !request.as_found;
  return options;
}

struct Scene {
  Octree environment;
  std::vector<Placed> objects;
  std::vector<Mover> movers;
};

Scene read_scene(Session& session, const Request& request) {
  Scene scene{read_solid(session, request.environment, request.environment_label), {}, {}};
  std::size_t resampled = 0;
  for (const std::string& name : request.objects) {
    const Octree object = read_solid(session, name, request.object_label);
    scene.objects.push_back(
        place_in(session, scene.environment, request.environment, object, name, resampled < request.resampled.size()));
    if (scene.objects.back().resampled) ++resampled;
  }
  if (resampled < request.resampled.size())
    session.warn(fmt::format("'{}' is not written: the voxels of the objects are those of the environment",
                             request.resampled[resampled]));
  for (std::size_t i = 0; i < request.moving.size(); ++i) {
    const std::string &octree_name = request.moving[i], &path_name = request.along[i];
    const Placed mover = place_in(session, scene.environment, request.environment,
                                  read_solid(session, octree_name, std::nullopt), octree_name, false);
    const Path path = session.stage("read", [&, &file = path_name](const Work&) {
      if (file != "-") {
        check_plain_input(file, "a path");
        return read_path(file).path;
      }
      const std::vector<std::uint8_t> bytes = read_bytes(file);
      return path_from_json({bytes.begin(), bytes.end()}, "standard input").path;
    });
    scene.movers.push_back({mover.octree, mover.in_environment(path)});
  }
  return scene;
}

// A path as it will stand in its file.
struct Answer {
  Plan plan;
  Path path;
  PathNotes notes;
  double least_clearance = 0;
};

// What is written is read again and checked as it was read.
Answer verified(Session& session, const Scene& scene, const Placed& object, Plan plan, const PlanOptions& options) {
  PathNotes notes;
  notes.clearance = plan.clearance;
  const double least = *std::min_element(plan.clearance.begin(), plan.clearance.end());
  if (least == std::numeric_limits<double>::infinity()) notes.clearance.clear();
  notes.length = plan.length;
  notes.planner = name_of(options.planner);
  notes.seconds = plan.seconds;
  notes.verified = true;
  const Path path = object.in_file(*plan.path);
  const Path read = path_from_json(to_json(path, notes), "the path").path;
  const bool clear = session.stage("verify", [&](const Work& work) {
    return path_is_clear(scene.environment, object.octree, object.in_environment(read), options.clearance, scene.movers,
                         work);
  });
  if (!clear) throw std::logic_error("a path that was found free is not so in its file");
  return {std::move(plan), path, notes, least};
}

int tell_none(const Session& session, const Plan& plan, const std::string& object, const PlanOptions& options) {
  const Pose& end = plan.nearest.back();
  if (session.json()) {
    Json way = Json::array();
    for (const Pose& pose : plan.nearest)
      way.push_back({{"translation", {pose.translation[0], pose.translation[1], pose.translation[2]}},
                     {"rotation", {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()}}});
    print_out(Json{{"found", false},
                   {"object", object},
                   {"planner", name_of(options.planner)},
                   {"seconds", plan.seconds},
                   {"missing", plan.missing},
                   {"nearest", way},
                   {"poses_tried", plan.poses_tried},
                   {"motions_tried", plan.motions_tried}});
  } else if (!session.quiet()) {
    print_out(fmt::format(
        "no path for '{}' was found within {:g} s; the nearest way ends {:.6g} voxels from the goal, at {}\n", object,
        options.seconds, plan.missing, shown(end)));
  }
  return kNo;
}

Json as_json(const Answer& answer, const std::string& output, const PlanOptions& options) {
  return {{"output", output},
          {"found", true},
          {"verified", true},
          {"planner", name_of(options.planner)},
          {"seed", options.seed},
          {"poses", answer.path.poses().size()},
          {"length", answer.plan.length},
          {"clearance", answer.notes.clearance.empty() ? Json() : Json(answer.least_clearance)},
          {"duration", answer.path.end()},
          {"seconds", answer.plan.seconds},
          {"poses_tried", answer.plan.poses_tried},
          {"motions_tried", answer.plan.motions_tried}};
}

std::string as_text(const Answer& answer, const std::string& output) {
  return fmt::format("{}: {}, {:.6g} voxels long, {}, verified\n", output, counted(answer.path.poses().size(), "pose"),
                     answer.plan.length,
                     answer.notes.clearance.empty()
                         ? "with nothing near"
                         : fmt::format("{:.4g} voxels clear at its poses", answer.least_clearance));
}

}  // namespace

int run_plan(Session& session) {
  Request request;
  declare(session.app(), request);
  session.add_json();
  session.set_example(
      "blackleaf plan --environment room.octree --object piano.octree --start 0,0,0 --goal 40,0,0@0,0,1:90 -o "
      "way.json");
  if (!session.parse()) return kDone;
  check(session, request);
  const PlanOptions options = options_of(request);
  std::vector<std::pair<Pose, Pose>> ends;
  for (std::size_t i = 0; i < request.objects.size(); ++i)
    ends.emplace_back(parse_pose("--start", request.starts[i]), parse_pose("--goal", request.goals[i]));

  Scene scene = read_scene(session, request);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Placed& object = scene.objects[i];
    Plan found = session.stage("plan", [&, &pair = ends[i]](const Work& work) {
      try {
        return plan(scene.environment, object.octree, pair.first, pair.second, options, scene.movers, work);
      } catch (const Error& error) {
        if (scene.objects.size() == 1 || error.code() == ErrorCode::cancelled) throw;
        throw Error(error.code(), fmt::format("'{}': {}", object.name, error.what()));
      }
    });
    if (!found.path) return tell_none(session, found, object.name, options);
    answers.push_back(verified(session, scene, object, std::move(found), options));
    scene.movers.push_back({object.octree, *answers.back().plan.path});
  }

  session.write_stage([&] {
    std::size_t resampled = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (scene.objects[i].resampled)
        save(scene.objects[i].octree, request.resampled[resampled++],
             metadata_text(session, scene.objects[i].name, {{"environment", base_name(request.environment)}}));
      if (request.outputs[i] == "-")
        print_out(to_json(answers[i].path, answers[i].notes));
      else
        write_path(answers[i].path, request.outputs[i], answers[i].notes);
    }
  });
  if (session.json()) {
    Json all = Json::array();
    for (std::size_t i = 0; i < answers.size(); ++i) all.push_back(as_json(answers[i], request.outputs[i], options));
    print_out(all.size() == 1 ? all[0] : Json{{"paths", all}});
  } else if (!session.quiet() && request.outputs[0] != "-") {
    for (std::size_t i = 0; i < answers.size(); ++i) print_out(as_text(answers[i], request.outputs[i]));
  }
  return kDone;
}

}  // namespace blackleaf::cli
