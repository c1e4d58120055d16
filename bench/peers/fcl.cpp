// FCL: collide() of OctoMap trees and of triangle meshes under trees of oriented boxes.
//
// Meshes are surfaces only: one wholly inside another does not collide with it.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "contact_poses.h"
#include "contenders.h"
#include "inputs.h"
#include "octomap_trees.h"

namespace blackleaf::bench {
namespace {

using Object = std::shared_ptr<fcl::CollisionGeometry<double>>;

Object tree_of(int depth) { return std::make_shared<fcl::OcTree<double>>(bunny_octomap(depth)); }

Object mesh_of(int depth) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSS<double>>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : bunny_mesh().triangles)
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  model->beginModel();
  model->addSubModel(bunny_points(depth), triangles);
  model->endModel();
  return model;
}

Ask colliding(const Object& a, const Object& b) {
  return [=](const Motion& motion) {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = motion.rotation();
    moved.translation() = motion.translation();
    const fcl::CollisionRequest<double> request;
    fcl::CollisionResult<double> result;
    return fcl::collide<double>(a.get(), Eigen::Isometry3d::Identity(), b.get(), moved, request, result) > 0;
  };
}

Ask apart(const Object& a, const Object& b) {
  return [=](const Motion& motion) {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = motion.rotation();
    moved.translation() = motion.translation();
    const fcl::DistanceRequest<double> request;
    fcl::DistanceResult<double> result;
    return fcl::distance<double>(a.get(), Eigen::Isometry3d::Identity(), b.get(), moved, request, result) > 0;
  };
}

}  // namespace

void add_fcl() {
  for (const int depth : {7, 8, 9}) {
    const std::string key = "interfere/" + side_name(depth);
    add_timed_poses(key, "fcl-octree", depth, [=] {
      const Object tree = tree_of(depth);
      return colliding(tree, tree);
    });
    // A tenth of a second a pose: once is enough.
    if (depth < 9)
      add_timed_poses(
          "distance/" + side_name(depth), "fcl-octree", depth,
          [=] {
            const Object tree = tree_of(depth);
            return apart(tree, tree);
          },
          1);
    add_timed_poses(key, "fcl-octree-mesh", depth, [=] { return colliding(tree_of(depth), mesh_of(depth)); });
    add_timed_poses(key, "fcl-mesh", depth, [=] {
      const Object mesh = mesh_of(depth);
      return colliding(mesh, mesh);
    });
    contender("prepare/" + side_name(depth), "fcl-mesh", [=](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(mesh_of(depth));
    });
  }
}

}  // namespace blackleaf::bench
