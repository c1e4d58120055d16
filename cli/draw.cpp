// blackleaf draw: the exact hidden-line drawing of an octree (VA88).
#include <fmt/format.h>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "commands.h"
#include "files.h"
#include "options.h"
#include "picture_options.h"

namespace blackleaf::cli {
namespace {

// "svg", "json", "png" or "pdf", from the suffix or, for standard output, from --format.
std::string format_of(const std::string& output, const std::optional<std::string>& format) {
  if (format && *format != "svg" && *format != "json" && *format != "png" && *format != "pdf")
    throw Error(ErrorCode::bad_argument, fmt::format("--format is '{}', which is unknown", *format),
                "use svg, json, png or pdf");
  if (output == "-") {
    if (!format || *format == "png" || *format == "pdf")
      throw Error(ErrorCode::bad_argument, "-o - can print svg or json only", "say --format svg or --format json");
    return *format;
  }
  const std::string suffix = suffix_of(output);
  if (suffix != ".svg" && suffix != ".json" && suffix != ".png" && suffix != ".pdf")
    throw Error(ErrorCode::bad_argument, fmt::format("cannot draw to '{}': unknown suffix '{}'", output, suffix),
                "use .svg, .json, .png or .pdf");
  if (format && "." + *format != suffix)
    throw Error(ErrorCode::bad_argument, fmt::format("--format {} contradicts the suffix of '{}'", *format, output),
                "leave it out");
  return suffix.substr(1);
}

}  // namespace

int run_draw(Session& session) {
  Label label;
  std::string input, view_text, output;
  std::optional<std::string> format;
  PictureOptions picture;
  add_octree_input(session.app(), "FILE", input);
  session.app()
      .add_option("--view", view_text,
                  "direction toward the viewer, rounded to 2^-20 of its largest component; +z is up in the picture")
      ->required()
      ->type_name("x,y,z");
  add_output(session.app(), output, "picture: .svg .json .png .pdf; - prints svg or json");
  add_text(session.app(), "--format", format, "FORMAT", "svg or json, for -o -");
  picture.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg");
  if (!session.parse()) return kDone;

  const std::string kind = format_of(output, format);
  picture.check(kind);
  const View view = parse_view(view_text);
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the picture to a file");
  if (output != "-") check_output(output);

  const Octree octree = read_solid(session, input, label);
  const LineDrawing drawing = session.stage("draw", [&](const Work& work) { return draw(octree, view, work); });
  const PageOptions page = picture.page(box_of(drawing));
  const double length = drawing.length();
  session.write_stage([&] {
    if (output != "-") return write_drawing(drawing, output, page);
    const std::string text = (kind == "svg" ? to_svg(drawing, page) : to_json(drawing)) + "\n";
    check_interrupt();
    print_out(text);
  });

  if (output == "-") return kDone;
  const std::optional<std::uint64_t> file_bytes = size_of(output);
  if (session.json())
    print_out(Json{{"output", output},
                   {"view", drawing.view.direction()},
                   {"strokes", drawing.strokes.size()},
                   {"length", length},
                   {"file_bytes", file_bytes ? Json(*file_bytes) : Json()}});
  else if (!session.quiet())
    print_out(fmt::format("{}: {} strokes, {:.6f} voxels long\n", output, grouped(drawing.strokes.size()), length));
  return kDone;
}

}  // namespace blackleaf::cli
