#include "place.h"

#include <cstdio>

#include "blackleaf/contact.h"
#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "blackleaf/move.h"
#include "blackleaf/set_operations.h"
#include "motion/extent.h"

namespace blackleaf::detail {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string place(const Eigen::Vector3d& at) {
  return "(" + number(at[0]) + ", " + number(at[1]) + ", " + number(at[2]) + ")";
}

std::string place(const std::array<std::int32_t, 3>& at) {
  return "(" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " + std::to_string(at[2]) + ")";
}

void require_in_universe(const World& world, const Pose& pose, const std::string& where) {
  try {
    const FixedMotion motion(world.motion(pose));
    target_universe(world.object().depth(), extent_of(world.object(), motion), Leaving::error);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::out_of_universe) throw;
    // Its remedies are those of a move.
    const std::string told = error.what();
    const std::string words = "the moved solid leaves the universe: ";
    const std::size_t from = told.starts_with(words) ? words.size() : 0;
    throw Error(ErrorCode::out_of_universe,
                where + " the object is outside the universe: " + told.substr(from, told.find(';') - from),
                "choose another pose or a larger universe");
  }
}

}  // namespace

void require_free(const World& world, const Pose& pose, const std::string& where) {
  require_in_universe(world, pose, where);
  if (world.is_free(pose)) return;
  const double needed = world.clearance_asked() + kMargin + kTolerance;
  const std::string remedy = "choose another pose, or a smaller clearance";
  const auto near = world.nearest(pose, std::max(needed, 0.0));
  if (!near)
    throw Error(ErrorCode::bad_argument,
                where + " the object is nearer to a wall of the universe than the clearance of " +
                    number(world.clearance_asked()) + " voxels",
                remedy);
  if (near->voxels > 0)
    throw Error(ErrorCode::bad_argument,
                where + " the object is " + number(near->voxels) + " voxels from the environment, at " +
                    place(near->on_a) + ", and a way needs a clearance of " + number(needed),
                remedy);
  const Octree common = intersect(world.environment(), move(world.object(), world.motion(pose), Leaving::clip));
  if (!common.is_empty()) {
    const Box box = *bounding_box(common);
    throw Error(ErrorCode::bad_argument,
                where + " the object interferes with the environment: " + std::to_string(volume(common)) +
                    " voxels overlap, from " + place(box.min) + " to " + place(box.max),
                "choose another pose");
  }
  const bool inside = interferes(world.environment(), world.object(), world.motion(pose), Meaning::exact);
  throw Error(ErrorCode::bad_argument,
              where +
                  (inside ? " the object interferes with the environment by less than a voxel, at "
                          : " the object touches the environment, at ") +
                  place(near->on_a),
              inside ? "choose another pose" : "lift it, or let it touch with a negative clearance like -0.02");
}

void refuse_for_traffic(const World& world, const Traffic& traffic, const Pose& pose, const std::string& where) {
  const double needed = world.clearance_asked() + kMargin + kTolerance;
  std::string what = where + " the object is in the way of a solid that moves";
  if (const auto near = traffic.nearest(pose, std::max(needed, 0.0)))
    what = where + " the object " +
           (near->at.voxels > 0 ? "is " + number(near->at.voxels) + " voxels from" : "touches") + " moving solid " +
           std::to_string(near->mover + 1) + ", at " + place(near->at.on_a);
  throw Error(ErrorCode::bad_argument, what, "choose another pose, or another path for the solid that moves");
}

}  // namespace blackleaf::detail
