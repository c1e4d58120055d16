// Hatching: parallel lines on the visible faces of a scene, so that shading survives a pen.
//
// A face looks along one of the axes. Faces that look along the same axis are hatched in one direction, at one
// distance, and the lines are those of the picture, not of each face: they run on over steps from face to face, as an
// illustrator draws them. Cut faces (Scene::without) are hatched in a direction and at a distance of their own.
//
// Which lines. Hatch lines of faces across axis n, b and c being the axes after it, run along h = e_b + e_c or
// h = e_b - e_c. Cut faces of solids with even places take the first of the two if it rises to the right on the screen
// (u.h and v.h are both positive, or neither is), else the second; all others take the other one. With w = h x d
// divided by the greatest common divisor of its components, all lines of the picture along h are w.p = k; voxel corners
// have whole k. Hatched are k = (2 m j + 1) / 512 for all whole j, where m is 256 times the distance in voxels times
// |w|, rounded, at least 1. So no hatch line ever meets a voxel's corner or falls on an edge, and lines are where they
// are whatever part of the solid is drawn.
#pragma once

#include <array>
#include <vector>

#include "blackleaf/drawing.h"
#include "blackleaf/scene.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct HatchOptions {
  /// Between lines on the picture, in voxels, for faces whose tone is 1; 0: faces are not hatched.
  double faces = 0;
  /// By axis (x, y, z) across the faces: how many times farther apart lines are; 0: none. Light comes from above.
  std::array<double, 3> tone = {1, 1.75, 0};
  /// The same distance for cut faces; 0: they are not hatched.
  double cuts = 0;
};

/// The hatch lines of a scene: kinds LineKind::hatch and LineKind::cut, the first of all solids, then the second, those
/// without strokes left out. A line is drawn where the first solid that its sight lines meet shows a face to be
/// hatched; a face belongs to the first solid of the scene that has the voxel behind it. Lines of cut faces lean to one
/// side for solids with even places in the scene and to the other for odd ones, so that neighbours differ. Exact:
/// decided in integers; stroke ends are rational. The same for every thread count. Cost: for each line, that of looking
/// at the visible surface along it. Throws Error(bad_argument) for distances and tones that are negative or not finite,
/// and for more than 2^20 lines; Error(cancelled).
std::vector<SceneLines> hatch(const Scene& scene, const View& view, const HatchOptions& options, const Work& work = {});

}  // namespace blackleaf
