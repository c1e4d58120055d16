// blackleaf draw: the exact hidden-line drawing of an octree (VA88).
#include <fmt/format.h>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "commands.h"
#include "draw_page.h"
#include "files.h"
#include "options.h"
#include "picture_options.h"

namespace blackleaf::cli {

int run_draw(Session& session) {
  Label label;
  std::string input, view_text, output;
  PageArguments page;
  add_octree_input(session.app(), "FILE", input);
  session.app()
      .add_option("--view", view_text,
                  "direction toward the viewer, rounded to 2^-20 of its largest component; +z is up in the picture")
      ->required()
      ->type_name("x,y,z");
  add_output(session.app(), output, "picture: .svg .pdf .png .hpgl .dxf .json; - prints svg, hpgl, dxf or json");
  page.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg");
  if (!session.parse()) return kDone;

  const PictureFormat format = page.format(output);
  page.check(format);
  const View view = parse_view(view_text);
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the picture to a file");
  if (output != "-") check_output(output);

  const Octree octree = read_solid(session, input, label);
  const LineDrawing drawing = session.stage("draw", [&](const Work& work) { return draw(octree, view, work); });
  if (drawing.strokes.empty()) session.warn("nothing is seen: the picture is empty");
  const double length = drawing.length();
  OrderedPicture ordered;
  if (format != PictureFormat::json)
    ordered = session.stage("order", [&](const Work&) {
      std::vector<Layer> layers;
      layers.push_back({"visible", {.width_mm = page.pen_width()}, polylines(drawing.strokes)});
      const PageOptions options = page.page_for(layers);
      Picture picture = lay_out(std::move(layers), view, options);
      picture.source = base_name(input);
      return ordered_picture(std::move(picture), page.joining(format));
    });
  session.write_stage([&] {
    if (output != "-") {
      if (format == PictureFormat::json) return write_drawing(drawing, output);
      return write_picture(ordered.picture, output);
    }
    const std::string text = format == PictureFormat::json ? to_json(drawing) : text_of(ordered.picture, format);
    check_interrupt();
    print_out(text);
  });

  if (output == "-") return kDone;
  const std::optional<std::uint64_t> file_bytes = size_of(output);
  if (session.json()) {
    Json report{{"output", output},
                {"view", view.direction()},
                {"strokes", drawing.strokes.size()},
                {"length", length},
                {"file_bytes", file_bytes ? Json(*file_bytes) : Json()}};
    if (page.stats()) report["pen"] = {{"before", stats_json(ordered.before)}, {"after", stats_json(ordered.after)}};
    print_out(report);
    return kDone;
  }
  if (!session.quiet())
    print_out(fmt::format("{}: {} strokes, {:.6f} voxels long\n", output, grouped(drawing.strokes.size()), length));
  if (page.stats()) print_out(stats_text(ordered.before, ordered.after));
  return kDone;
}

}  // namespace blackleaf::cli
