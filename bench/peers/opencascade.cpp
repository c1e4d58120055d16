// OpenCASCADE: hidden lines of the same voxel surface. The unit squares of the surface share their edges and vertices;
// faces in one plane and edges in one line are then merged (ShapeUpgrade_UnifySameDomain), which leaves the feature
// edges. Merging, and meshing for the algorithm that wants triangles, are not counted.
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_Algo.hxx>
#include <HLRBRep_HLRToShape.hxx>
#include <HLRBRep_PolyAlgo.hxx>
#include <HLRBRep_PolyHLRToShape.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Pln.hxx>
#include <map>
#include <vector>

#include "contenders.h"
#include "drawn.h"

namespace blackleaf::bench {
namespace {

using Place = std::array<int, 3>;

// The surface of a solid as a shell of unit squares.
class Surface {
 public:
  explicit Surface(const Octree& octree) {
    build_.MakeShell(shell_);
    const int side = octree.side();
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          if (!octree.contains(x, y, z)) continue;
          for (std::size_t axis = 0; axis < 3; ++axis)
            for (const bool high : {false, true}) {
              Place beside = {x, y, z};
              beside[axis] += high ? 1 : -1;
              if (!octree.contains(beside[0], beside[1], beside[2])) add({x, y, z}, axis, high);
            }
        }
    shell_.Closed(true);
  }
  const TopoDS_Shell& shell() const { return shell_; }

 private:
  static Place moved(Place place, std::size_t axis) {
    ++place[axis];
    return place;
  }
  static gp_Dir unit(std::size_t axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

  void add(const Place& voxel, std::size_t axis, bool high) {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    const Place at = high ? moved(voxel, axis) : voxel;
    TopoDS_Wire wire;
    build_.MakeWire(wire);
    build_.Add(wire, edge(at, b).Oriented(TopAbs_FORWARD));
    build_.Add(wire, edge(moved(at, b), c).Oriented(TopAbs_FORWARD));
    build_.Add(wire, edge(moved(at, c), b).Oriented(TopAbs_REVERSED));
    build_.Add(wire, edge(at, c).Oriented(TopAbs_REVERSED));
    wire.Closed(true);
    TopoDS_Face face = BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3(gp_Pnt(at[0], at[1], at[2]), unit(axis), unit(b))), wire);
    if (!high) face.Reverse();
    build_.Add(shell_, face);
  }
  const TopoDS_Vertex& vertex(const Place& at) {
    TopoDS_Vertex& found = vertices_[at];
    if (found.IsNull()) found = BRepBuilderAPI_MakeVertex(gp_Pnt(at[0], at[1], at[2]));
    return found;
  }
  const TopoDS_Edge& edge(const Place& at, std::size_t axis) {
    TopoDS_Edge& found = edges_[{at, axis}];
    if (found.IsNull()) found = BRepBuilderAPI_MakeEdge(vertex(at), vertex(moved(at, axis)));
    return found;
  }

  BRep_Builder build_;
  TopoDS_Shell shell_;
  std::map<Place, TopoDS_Vertex> vertices_;
  std::map<std::pair<Place, std::size_t>, TopoDS_Edge> edges_;
};

// Merged and meshed; made once in a process.
const TopoDS_Shape& merged_ball(int radius) {
  static std::map<int, TopoDS_Shape> made;
  TopoDS_Shape& shape = made[radius];
  if (shape.IsNull()) {
    ShapeUpgrade_UnifySameDomain merge(Surface(ball_of_radius(radius)).shell(), /*UnifyEdges=*/true,
                                       /*UnifyFaces=*/true, /*ConcatBSplines=*/false);
    merge.Build();
    shape = merge.Shape();
    BRepMesh_IncrementalMesh(shape, 0.1);
  }
  return shape;
}

HLRAlgo_Projector projector() {
  const Eigen::Vector3d& d = ball_direction();
  // To the right: z x d.
  return HLRAlgo_Projector(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(d[0], d[1], d[2]), gp_Dir(-d[1], d[0], 0)));
}

// Of the union: two edges can have one picture, and OpenCASCADE then draws the place twice (1.15 voxels of the ball of
// radius 32).
double length_of(const TopoDS_Shape& lines) {
  if (lines.IsNull()) return 0;
  // By direction and offset, in millionths: what is drawn of a line.
  std::map<std::pair<long, long>, std::vector<std::pair<double, double>>> drawn;
  for (TopExp_Explorer at(lines, TopAbs_EDGE); at.More(); at.Next()) {
    const BRepAdaptor_Curve line(TopoDS::Edge(at.Current()));
    const gp_Pnt from = line.Value(line.FirstParameter()), to = line.Value(line.LastParameter());
    Eigen::Vector2d along(to.X() - from.X(), to.Y() - from.Y());
    if (along.norm() == 0) continue;
    along.normalize();
    if (along[0] < -1e-9 || (along[0] < 1e-9 && along[1] < 0)) along = -along;
    const double s = along[0] * from.X() + along[1] * from.Y(), t = along[0] * to.X() + along[1] * to.Y();
    const double offset = along[0] * from.Y() - along[1] * from.X();
    drawn[{std::lround(1e6 * std::atan2(along[1], along[0])), std::lround(1e6 * offset)}].push_back(std::minmax(s, t));
  }
  double length = 0;
  for (auto& [line, stretches] : drawn) {
    std::sort(stretches.begin(), stretches.end());
    double until = stretches.front().first;
    for (const auto& [low, high] : stretches) {
      length += std::max(0.0, high - std::max(low, until));
      until = std::max(until, high);
    }
  }
  return length;
}

Handle(HLRBRep_PolyAlgo) by_triangles(const TopoDS_Shape& shape) {
  Handle(HLRBRep_PolyAlgo) algorithm = new HLRBRep_PolyAlgo();
  algorithm->Load(shape);
  algorithm->Projector(projector());
  algorithm->Update();
  return algorithm;
}

Handle(HLRBRep_Algo) exactly(const TopoDS_Shape& shape) {
  Handle(HLRBRep_Algo) algorithm = new HLRBRep_Algo();
  algorithm->Add(shape);
  algorithm->Projector(projector());
  algorithm->Update();
  algorithm->Hide();
  return algorithm;
}

double length_by_triangles(int radius) {
  HLRBRep_PolyHLRToShape lines;
  lines.Update(by_triangles(merged_ball(radius)));
  return length_of(lines.VCompound());
}

double exact_length(int radius) {
  HLRBRep_HLRToShape lines(exactly(merged_ball(radius)));
  TopoDS_Shape visible = lines.VCompound();
  BRepLib::BuildCurves3d(visible);
  return length_of(visible);
}

}  // namespace

void add_opencascade() {
  for (const int radius : {8, 16, 32, 64}) {
    const std::string ball = "ball" + std::to_string(radius);
    auto* poly = contender("draw/" + ball + "/t1", "opencascade-poly", [=](benchmark::State& state) {
      const TopoDS_Shape& shape = merged_ball(radius);
      for (auto _ : state) benchmark::DoNotOptimize(by_triangles(shape));
    });
    if (radius >= 32) poly->Iterations(1)->Repetitions(3);
    counted("length/" + ball, "opencascade-poly", [=] { return length_by_triangles(radius); });
    if (radius > 32) continue;  // half a minute
    auto* exact = contender("draw/" + ball + "/t1", "opencascade-exact", [=](benchmark::State& state) {
      const TopoDS_Shape& shape = merged_ball(radius);
      for (auto _ : state) benchmark::DoNotOptimize(exactly(shape));
    });
    if (radius >= 16) exact->Iterations(1)->Repetitions(3);
    counted("length/" + ball, "opencascade-exact", [=] { return exact_length(radius); });
  }
}

}  // namespace blackleaf::bench
