// blackleaf draw: exact hidden-line drawings of octrees (VA88).
#include <fmt/format.h>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "commands.h"
#include "draw_page.h"
#include "draw_pens.h"
#include "draw_sheet.h"
#include "file/atomic_write.h"
#include "files.h"
#include "options.h"
#include "picture_options.h"

namespace blackleaf::cli {
namespace {

// A picture without a page, and with one.
struct Result {
  std::optional<View> view;   // of a picture without a sheet
  std::vector<Layer> layers;  // of that, in voxels
  std::size_t strokes = 0;
  double length = 0;  // voxels
  std::optional<OrderedPicture> page;
};

// What is seen from one side, in voxels.
std::vector<Layer> layers_of(const Octree& octree, const View& view, const PenArguments& pens, Result& result,
                             const Work& work) {
  const LineDrawing drawing = draw(octree, view, work);
  result.strokes += drawing.strokes.size();
  result.length += drawing.length();
  std::vector<Layer> layers;
  layers.push_back({"visible", pens.pen(), polylines(drawing.strokes)});
  return layers;
}

void report(const Session& session, const std::string& output, const Result& result, bool stats) {
  const std::optional<std::uint64_t> file_bytes = size_of(output);
  if (session.json()) {
    Json json{{"output", output}};
    if (result.view) json["view"] = result.view->direction();
    json["strokes"] = result.strokes;
    json["length"] = result.length;
    json["file_bytes"] = file_bytes ? Json(*file_bytes) : Json();
    if (stats) json["pen"] = {{"before", stats_json(result.page->before)}, {"after", stats_json(result.page->after)}};
    print_out(json);
    return;
  }
  if (!session.quiet())
    print_out(fmt::format("{}: {} strokes, {:.6f} voxels long\n", output, grouped(result.strokes), result.length));
  if (stats) print_out(stats_text(result.page->before, result.page->after));
}

}  // namespace

int run_draw(Session& session) {
  Label label;
  std::string input, output;
  std::optional<std::string> view_text;
  PageArguments page;
  PenArguments pens;
  SheetArguments sheet;
  add_octree_input(session.app(), "FILE", input);
  add_text(session.app(), "--view", view_text, "x,y,z",
           "direction toward the viewer, rounded to 2^-20 of its largest component; +z is up in the picture");
  add_output(session.app(), output, "picture: .svg .pdf .png .hpgl .dxf .json; - prints svg, hpgl, dxf or json");
  page.add_to(session.app());
  pens.add_to(session.app());
  sheet.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg");
  if (!session.parse()) return kDone;

  const PictureFormat format = page.format(output);
  const bool in_voxels = format == PictureFormat::json && !sheet.given();
  page.check(in_voxels, pens.given());
  pens.check();
  sheet.check(page.size());
  Result result;
  if (!sheet.given()) {
    if (!view_text)
      throw Error(ErrorCode::bad_argument, "--view is required", "give one like --view 3,-4,2, or --sheet");
    result.view = parse_view(*view_text);
  } else if (view_text) {
    throw Error(ErrorCode::bad_argument, "--sheet has views of its own", "leave out --view");
  }
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the picture to a file");
  if (output != "-") check_output(output);

  const Octree octree = read_solid(session, input, label);
  const std::string source = base_name(input);
  Picture picture = session.stage("draw", [&](const Work& work) {
    if (!sheet.given()) {
      result.layers = layers_of(octree, *result.view, pens, result, work);
      return in_voxels ? Picture{} : lay_out(result.layers, *result.view, page.page_for(result.layers));
    }
    const SheetOptions options = sheet.options(page.size(), page.title().value_or(source), source, octree.frame());
    std::array<std::vector<Layer>, 4> views;
    const std::array<View, 4> directions = sheet_views(options.angle);
    for (std::size_t i = 0; i < views.size(); ++i) views[i] = layers_of(octree, directions[i], pens, result, work);
    return engineering_sheet(views, options);
  });
  if (result.strokes == 0) session.warn("nothing is seen: the picture is empty");
  if (!in_voxels) {
    picture.source = source;
    result.page =
        session.stage("order", [&](const Work&) { return ordered_picture(std::move(picture), page.joining(format)); });
  }
  session.write_stage([&] {
    if (output != "-" && !in_voxels) return write_picture(result.page->picture, output);
    std::string text;
    if (!in_voxels) {
      text = text_of(result.page->picture, format);
    } else {
      text = to_json(result.layers[0].lines, *result.view);
    }
    if (output != "-") return detail::write_atomically(output, text);
    check_interrupt();
    print_out(text);
  });
  if (output != "-") report(session, output, result, page.stats());
  return kDone;
}

}  // namespace blackleaf::cli
