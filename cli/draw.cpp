// blackleaf draw: exact hidden-line drawings of octrees (VA88), of one or several in a picture.
#include <fmt/format.h>

#include <limits>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "blackleaf/perspective.h"
#include "commands.h"
#include "draw_eye.h"
#include "draw_page.h"
#include "draw_pens.h"
#include "draw_scene.h"
#include "draw_sheet.h"
#include "file/atomic_write.h"
#include "files.h"
#include "options.h"
#include "picture_options.h"

namespace blackleaf::cli {
namespace {

// A picture without a page, and with one.
struct Result {
  std::optional<View> view;                // of a picture without a sheet
  std::optional<Perspective> perspective;  // if it is one
  std::vector<Layer> layers;               // of that, in voxels
  std::size_t strokes = 0;
  double length = 0;  // voxels
  std::optional<OrderedPicture> page;
};

// What is seen from one side.
struct Seen {
  Scene scene;  // cut open
  bool cut = false;
  std::vector<SceneLines> lines;
};

Seen seen_from(const NamedScene& named, const SceneArguments& scene, const PenArguments& pens, const View& view,
               const Work& work, const std::optional<Perspective>& perspective = {}) {
  bool cut = false;
  Scene opened = scene.seen_from(named.scene, view, cut, {work.threads, {}});
  Seen seen{std::move(opened), cut, {}};
  SceneOptions options = pens.lines(seen.scene.all().side());
  if (perspective) {
    options.outline_gap = std::numeric_limits<double>::infinity();
    seen.cut = false;  // nothing is hatched in perspective
    seen.lines = draw(seen.scene, *perspective, options, work);
  } else {
    seen.lines = draw(seen.scene, view, options, work);
  }
  return seen;
}

// Adds the hatching of a picture whose scale is known by now.
void add_hatching(Seen& seen, const PenArguments& pens, const View& view, std::optional<double> mm_per_voxel,
                  const Work& work) {
  if (!pens.lines(1).visible) return;
  for (SceneLines& lines : hatch(seen.scene, view, pens.hatching(mm_per_voxel, seen.cut), work))
    seen.lines.push_back(std::move(lines));
}

std::vector<Layer> layers_of(const NamedScene& named, const PenArguments& pens, Seen seen, Result& result) {
  for (const SceneLines& lines : seen.lines) {
    result.strokes += lines.strokes.size();
    for (const Stroke& stroke : lines.strokes) result.length += (stroke.to - stroke.from).norm();
  }
  return pens.layers(named, std::move(seen.lines));
}

Picture page_of(const NamedScene& named, const SceneArguments& scene, const PenArguments& pens,
                const PageArguments& page, Result& result, const Work& work) {
  const View& view = *result.view;
  Seen seen = seen_from(named, scene, pens, view, work, result.perspective);
  const bool hatched = pens.hatch() || seen.cut;
  std::vector<Layer> layers = pens.layers(named, seen.lines);
  const PageOptions options = page.page_for(layers);
  // Hatching stays within the other lines, so the scale does not depend on it.
  if (hatched) add_hatching(seen, pens, view, lay_out(std::move(layers), view, options).views[0].mm_per_voxel, work);
  return lay_out(layers_of(named, pens, std::move(seen), result), view, options);
}

Picture sheet_of(const NamedScene& named, const SceneArguments& scene, const PenArguments& pens,
                 const SheetOptions& options, Result& result, const Work& work) {
  const std::array<View, 4> directions = sheet_views(options.angle);
  std::vector<Seen> seen;
  std::array<std::vector<Layer>, 4> views;
  bool cut = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    seen.push_back(seen_from(named, scene, pens, directions[i], work));
    cut = cut || seen[i].cut;
    views[i] = pens.layers(named, seen[i].lines);
  }
  if (pens.hatch() || cut) {
    const double mm_per_voxel = engineering_sheet(views, options).views[0].mm_per_voxel;
    for (std::size_t i = 0; i < views.size(); ++i) add_hatching(seen[i], pens, directions[i], mm_per_voxel, work);
  }
  for (std::size_t i = 0; i < views.size(); ++i) views[i] = layers_of(named, pens, std::move(seen[i]), result);
  return engineering_sheet(views, options);
}

void report(const Session& session, const std::string& output, const Result& result, bool stats) {
  const std::optional<std::uint64_t> file_bytes = size_of(output);
  if (session.json()) {
    Json json{{"output", output}};
    if (result.view) json["view"] = result.view->direction();
    if (result.perspective) {
      const EyePoint& point = *result.view->eye_point();
      json["eye"] = {point.eye[0], point.eye[1], point.eye[2]};
      json["target"] = {point.target[0], point.target[1], point.target[2]};
    }
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
  std::string output;
  std::optional<std::string> view_text;
  SceneArguments scene;
  EyeArguments eye;
  PageArguments page;
  PenArguments pens;
  SheetArguments sheet;
  scene.add_to(session.app());
  add_text(session.app(), "--view", view_text, "x,y,z",
           "direction toward the viewer, rounded to 2^-20 of its largest component; +z is up in the picture");
  eye.add_to(session.app());
  add_output(session.app(), output, "picture: .svg .pdf .png .hpgl .dxf .json; - prints svg, hpgl, dxf or json");
  page.add_to(session.app());
  pens.add_to(session.app());
  sheet.add_to(session.app());
  session.add_json();
  session.set_example("blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg");
  if (!session.parse()) return kDone;

  const PictureFormat format = page.format(output);
  const bool in_voxels = format == PictureFormat::json && !sheet.given();
  scene.check();
  pens.check(in_voxels, scene.cut());
  // JSON of one kind of lines has strokes only, and no layers that could have pens.
  page.check(in_voxels, pens.given() && pens.plain() && scene.file_count() == 1);
  sheet.check(page.size());
  using Other = std::optional<std::string>;
  eye.check(view_text ? Other("--view") : sheet.given() ? Other("--sheet") : std::nullopt);
  if (eye.given()) pens.check_perspective();
  Result result;
  if (!sheet.given()) {
    if (!view_text && !eye.given())
      throw Error(ErrorCode::bad_argument, "--view is required", "give one like --view 3,-4,2, or --eye, or --sheet");
    if (view_text) {
      result.view = parse_view(*view_text);
      scene.require_faced(*result.view);
    }
  } else if (view_text) {
    throw Error(ErrorCode::bad_argument, "--sheet has views of its own", "leave out --view");
  }
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the picture to a file");
  if (output != "-") check_output(output);

  const NamedScene named = scene.read(session);
  pens.check(named);
  if (eye.given()) {
    result.perspective = eye.perspective(named.scene.all());
    result.view = result.perspective->view();
    scene.require_faced(*result.view);
  }
  const std::string source = scene.source();
  Picture picture = session.stage("draw", [&](const Work& work) {
    if (sheet.given()) {
      const SheetOptions options =
          sheet.options(page.size(), page.title().value_or(source), source, named.scene.all().frame());
      return sheet_of(named, scene, pens, options, result, work);
    }
    if (!in_voxels) return page_of(named, scene, pens, page, result, work);
    Seen seen = seen_from(named, scene, pens, *result.view, work, result.perspective);
    if (pens.hatch() || seen.cut) add_hatching(seen, pens, *result.view, std::nullopt, work);
    result.layers = layers_of(named, pens, std::move(seen), result);
    return Picture{};
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
      const bool plain = named.solids.size() == 1 && pens.plain() && !scene.cut();
      text = plain ? to_json(result.layers[0].lines, *result.view) : to_json(result.layers, *result.view);
    }
    if (output != "-") return detail::write_atomically(output, text);
    check_interrupt();
    print_out(text);
  });
  if (output != "-") report(session, output, result, page.stats());
  return kDone;
}

}  // namespace blackleaf::cli
