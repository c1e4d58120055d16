#include "collide_path.h"

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/first_contact.h"
#include "options.h"
#include "path_input.h"

namespace blackleaf::cli {
namespace {

Json as_json(const Eigen::Vector3d& v) { return Json{v[0], v[1], v[2]}; }

std::string in_words(const Eigen::Vector3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]); }

// Both with the precision that --tolerance has.
void print_clear(const Session& session, const std::optional<Clearance>& clearance) {
  if (session.json()) {
    Json report = {{"clear", true}, {"first_contact", nullptr}, {"clearance", nullptr}};
    if (clearance)
      report["clearance"] = {
          {"at_least", clearance->at_least}, {"at_most", clearance->at_most}, {"time", clearance->time}};
    print_out(report);
  } else if (!session.quiet()) {
    print_out(clearance ? fmt::format("the way is clear: at least {:.6g} voxels apart, nearest at time {:.6g}\n",
                                      clearance->at_least, clearance->time)
                        : "the way is clear\n");
  }
}

void print_contact(const Session& session, const FirstContact& contact) {
  const Eigen::Quaterniond& q = contact.pose_b.rotation;
  const Eigen::Vector3d place = (contact.on_a + contact.on_b) / 2;
  if (session.json()) {
    print_out(Json{
        {"clear", false},
        {"first_contact",
         {{"time", contact.time},
          {"pose", {{"translation", as_json(contact.pose_b.translation)}, {"rotation", {q.w(), q.x(), q.y(), q.z()}}}},
          {"place", as_json(place)},
          {"distance", contact.distance}}},
        {"clearance", nullptr}});
  } else if (!session.quiet()) {
    print_out(fmt::format("first contact at time {:.9g}, at {}: {}\n", contact.time, in_words(place),
                          contact.distance > 0   ? fmt::format("{:.3g} voxels apart", contact.distance)
                          : contact.distance < 0 ? fmt::format("{:.3g} voxels deep", -contact.distance)
                                                 : std::string("they touch")));
  }
}

}  // namespace

void CollidePath::add_to(App& app) {
  add_text(app, "--path", path_, "PATH",
           "ask for the first contact of B on this path, a JSON file; or - for standard input");
  add_number(app, "--clearance", clearance_, false,
             "with --path: contact is to come within F voxels; negative: to overlap more than F deep (default 0)");
  add_number(app, "--tolerance", tolerance_, true,
             "with --path: what comes within F voxels of that may be called contact (default 0.001)");
}

void CollidePath::check(const std::string& a_name, const std::string& b_name, bool something_else) const {
  if (path_ && something_else)
    throw Error(ErrorCode::bad_argument, "--path and another question or motion of B are both given",
                "leave out --path, or --rotate, --translate, --about, --matrix, --exact, --poses and -o");
  if (!path_ && (clearance_ || tolerance_))
    throw Error(ErrorCode::bad_argument, "--clearance and --tolerance are of a path", "give one with --path");
  if (path_ == "-" && (a_name == "-" || b_name == "-"))
    throw Error(ErrorCode::bad_argument, "an octree and the path are both - for standard input",
                "name a file for one of them");
}

bool CollidePath::answer(Session& session, const Octree& a, const Octree& b) const {
  const Path path = read_path_input(session, *path_, {});
  const ContactOptions options{clearance_.value_or(0), tolerance_.value_or(ContactOptions{}.tolerance)};
  const PreparedSolid solid_a(a), solid_b(b);
  const std::optional<FirstContact> contact =
      session.stage("collide", [&](const Work& work) { return first_contact(solid_a, solid_b, path, options, work); });
  if (contact) {
    print_contact(session, *contact);
    return true;
  }
  const bool asked = session.json() || !session.quiet();
  constexpr double kPrecision = 1e-2;
  print_clear(session, asked ? session.stage("collide",
                                             [&](const Work& work) {
                                               return clearance(solid_a, solid_b, path, kPrecision, work);
                                             })
                             : std::nullopt);
  return false;
}

}  // namespace blackleaf::cli
