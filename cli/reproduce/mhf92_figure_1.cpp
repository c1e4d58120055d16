#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/drawing.h"
#include "canvas.h"
#include "exhibit.h"

namespace blackleaf::cli {
namespace {

// The nodes of M_i, in order.
std::vector<curve::Voxel> nodes_of(int order) {
  std::vector<curve::Voxel> nodes;
  if (order == 0) return {{0, 0, 0}};
  curve::walk(order, 0, std::uint64_t{1} << (3 * order), [&](const curve::Voxel& voxel) { nodes.push_back(voxel); });
  return nodes;
}

constexpr double kSide = 80;  // millimetres

// The curve as seen from `view`, far links first, each on a white band that parts it from those behind it.
std::string curve_svg(int order, const View& view) {
  const std::vector<curve::Voxel> nodes = nodes_of(order);
  const double side = static_cast<double>((1 << order) - 1), unit = order == 0 ? 1 : 46 / side;
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(side / 2);
  const auto point = [](const curve::Voxel& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  const auto seen = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = unit * (p - middle);
    return Eigen::Vector2d(kSide / 2 + view.right().dot(q), kSide / 2 - view.up().dot(q));
  };
  const Eigen::Vector3d toward(static_cast<double>(view.direction()[0]), static_cast<double>(view.direction()[1]),
                               static_cast<double>(view.direction()[2]));
  std::vector<std::size_t> links(nodes.size() - 1);
  for (std::size_t i = 0; i < links.size(); ++i) links[i] = i;
  const auto depth = [&](std::size_t i) { return toward.dot(point(nodes[i]) + point(nodes[i + 1])); };
  std::sort(links.begin(), links.end(), [&](std::size_t i, std::size_t k) { return depth(i) < depth(k); });

  Canvas canvas(kSide, kSide);
  const double width = order == 1 ? 0.9 : 0.7;
  for (const std::size_t i : links) {
    const Eigen::Vector2d from = seen(point(nodes[i])), to = seen(point(nodes[i + 1])), link = to - from;
    canvas.line(from + 0.25 * link, to - 0.25 * link, "white", 2.6 * width);
    canvas.line(from, to, "black", width);
  }
  // The first node is empty, the last one full.
  canvas.circle(seen(point(nodes.front())), 1.3, nodes.size() == 1 ? "black" : "white", "black", 0.4);
  if (nodes.size() > 1) canvas.circle(seen(point(nodes.back())), 1.3, "black");
  if (order == 1)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      canvas.text(seen(point(nodes[i])) + Eigen::Vector2d(2, -1.5), std::to_string(i), 4);
  return canvas.svg();
}

}  // namespace

Exhibit mhf92_figure_1(const Work&) {
  const View view({3, -10, 6});
  Canvas canvas(3 * kSide, kSide + 8);
  std::string csv = "order,node,x,y,z\n";
  for (int order = 0; order <= 2; ++order) {
    canvas.figure({kSide * order, 0}, curve_svg(order, view));
    canvas.text({kSide * (order + 0.5), kSide + 5}, fmt::format("M_{}", order), 5, Canvas::Anchor::middle);
    std::size_t number = 0;
    for (const curve::Voxel& v : nodes_of(order))
      csv += fmt::format("{},{},{},{},{}\n", order, number++, v.x, v.y, v.z);
  }
  Exhibit exhibit{"mhf92-figure-1", "MHF92, Figure 1: the Millar polyhedra M_0, M_1 and M_2", {}, {}, {}};
  exhibit.body =
      paragraph(
          "<b>In the paper.</b> The polyhedron M<sub>0</sub> is a point; M<sub>i</sub> is made of eight copies of "
          "M<sub>i&minus;1</sub>, each turned or reflected, and linked. The curve starts at one corner of the lattice "
          "and climbs around every point, once each, to emerge at another corner.") +
      paragraph(
          "<b>Here.</b> The node numbers' voxels by the product's tables (all 24 of them are compared with the "
          "paper's appendix in the tests): x to the right, y away from the viewer, z upward. The curve begins at the "
          "empty circle and ends at the full one.") +
      "<figure>" + canvas.svg() + "</figure>\n";
  exhibit.files = {{"mhf92-figure-1.svg", canvas.file()}, {"mhf92-figure-1.csv", csv}};
  return exhibit;
}

}  // namespace blackleaf::cli
