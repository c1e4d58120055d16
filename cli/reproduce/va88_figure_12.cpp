#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <optional>

#include "blackleaf/drawing.h"
#include "blackleaf/error.h"
#include "blackleaf/measures.h"
#include "canvas.h"
#include "chart.h"
#include "exhibit.h"
#include "papers/va88.h"
#include "va88_objects.h"

namespace blackleaf::cli {
namespace {

namespace va88 = papers::va88;

// What the figure may take: of boxes compared, by the paper's letter and with its test of extents.
constexpr std::uint64_t kMostComparisons = 16'000'000, kMostComparisonsOfExtents = 100'000'000;
constexpr int kSmallestDepth = 3, kLargestDepth = 7;

// CPU seconds of one thread, which leave out what other programs do meanwhile.
double seconds_of(const std::function<void()>& run) {
  const std::clock_t begin = std::clock();
  run();
  return std::max(1e-6, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
}
// Of two runs the shorter: the first one finds memory and caches cold.
double shorter_of_two(const std::function<void()>& run) { return std::min(seconds_of(run), seconds_of(run)); }

struct Row {
  std::string object;
  int depth = 0;
  std::uint64_t nodes = 0, black = 0;
  std::size_t boxes = 0, strokes = 0;
  std::uint64_t comparisons = 0;
  std::optional<double> every_edge, extents;  // seconds
  double ours = 0;
};

Row measured(int figure, int depth, const Eigen::Vector3d& direction) {
  const Va88Object object = va88_object(figure, depth);
  const Octree octree = octree_from_silhouettes(object.silhouettes, depth, {}, {1, {}});
  const Measures measures = measure(octree);
  Row row;
  row.object = object.name;
  row.depth = depth;
  row.nodes = 8 * measures.internal_nodes + 1;
  row.black = measures.black_leaves;
  LineDrawing drawing{View(direction), {}};
  row.ours = shorter_of_two([&] { drawing = draw(octree, View(direction), {1, {}}); });
  row.strokes = drawing.strokes.size();
  const std::uint64_t most = row.black * (row.black - 1) / 2;  // there is at most one box a black leaf
  const auto paper = [&](va88::Comparing comparing) {
    return seconds_of([&] {
      const va88::Drawing printed = va88::draw(octree, direction, comparing);
      row.boxes = printed.graphics_nodes;
      row.comparisons = printed.comparisons;
    });
  };
  if (most <= kMostComparisons) row.every_edge = paper(va88::Comparing::every_edge);
  if (most <= kMostComparisonsOfExtents) row.extents = paper(va88::Comparing::extents);
  return row;
}

std::string shown(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.3g}", 1e3 * *seconds) : "–";
}

Table table_of(const std::vector<Row>& rows) {
  Table table{"CPU times in milliseconds, one thread, measured when this page was made",
              {"object", "depth", "nodes", "black", "boxes", "comparisons", "VA88, every edge", "VA88, extents first",
               "ours", "VA88 / ours"},
              {}};
  for (const Row& row : rows)
    table.rows.push_back({row.object, std::to_string(row.depth), std::to_string(row.nodes), std::to_string(row.black),
                          row.boxes ? std::to_string(row.boxes) : "–",
                          row.boxes ? std::to_string(row.comparisons) : "–", shown(row.every_edge), shown(row.extents),
                          shown(row.ours),
                          row.every_edge ? fmt::format("{:.3g}", *row.every_edge / row.ours)
                          : row.extents  ? fmt::format("{:.3g}", *row.extents / row.ours)
                                         : "–"});
  return table;
}

}  // namespace

Exhibit va88_figure_12(const Work& work) {
  const Eigen::Vector3d direction(12, -16, 15);
  std::vector<Row> rows;
  constexpr int kRows = (kVa88LastFigure - kVa88FirstFigure + 1) * (kLargestDepth - kSmallestDepth + 1);
  for (int figure = kVa88FirstFigure; figure <= kVa88LastFigure; ++figure)
    for (int depth = kSmallestDepth; depth <= kLargestDepth; ++depth) {
      rows.push_back(measured(figure, depth, direction));
      if (work.progress && !work.progress(static_cast<double>(rows.size()) / kRows))
        throw Error(ErrorCode::cancelled, "interrupted");
    }

  std::vector<ChartPoint> nodes, black, extents, ours, by_boxes;
  for (const Row& row : rows) {
    const double total = static_cast<double>(row.nodes);
    if (row.every_edge) {
      nodes.push_back({total, *row.every_edge});
      black.push_back({static_cast<double>(row.black), *row.every_edge});
      by_boxes.push_back({static_cast<double>(row.boxes), *row.every_edge});
    }
    if (row.extents) extents.push_back({total, *row.extents});
    ours.push_back({total, row.ours});
  }
  const Chart chart{"nodes of the octree",
                    "seconds",
                    {{"VA88: all nodes", 'o', "black", nodes},
                     {"VA88: black nodes", '+', "black", black},
                     {"VA88, extents first: all nodes", 'o', "#999", extents},
                     {"ours: all nodes", '*', "#c33", ours}}};
  const Table table = table_of(rows);
  const std::string svg = chart.svg();

  Exhibit exhibit{"va88-figure-12", "VA88, Figure 12: drawing time and the number of nodes", {}, {}, {}};
  exhibit.body =
      paragraph(
          "<b>In the paper.</b> &ldquo;Graph of line drawing generation time as a function of the number of nodes in "
          "the octree: &lsquo;o&rsquo; represents total nodes; &lsquo;+&rsquo; represents black (leaf) "
          "nodes.&rdquo; There is &ldquo;no simple relationship between the two&rdquo;: every graphics node is "
          "compared with all before it, the square of their number, but what a comparison costs depends on how "
          "much of the image overlaps.") +
      paragraph(fmt::format(
          "<b>Here.</b> <b>Measured times</b>: they differ from machine to machine and from run to run. The objects of "
          "Figures 5 to 11 at depths {} to {}, seen from (12, -16, 15), both axes logarithmic. Fitted growth: the "
          "paper's "
          "algorithm with the power {:.2f} of its boxes (2 is the square), ours with the power {:.2f} of all nodes. "
          "The paper's algorithm is run where it has at most {} comparisons; where it first compares the extents of "
          "two "
          "projections, which section 3.2 may mean, up to {}. The last column is that of every edge where it was run.",
          kSmallestDepth, kLargestDepth, growth_exponent(by_boxes), growth_exponent(ours), kMostComparisons,
          kMostComparisonsOfExtents)) +
      "<figure>" + svg + "</figure>\n" + table.html();
  exhibit.files = {{"va88-figure-12.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg},
                   {"va88-figure-12.csv", table.csv()}};
  return exhibit;
}

}  // namespace blackleaf::cli
