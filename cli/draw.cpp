// blackleaf draw: the exact hidden-line drawing of an octree (VA88).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "blackleaf/drawing.h"
#include "blackleaf/drawing_file.h"
#include "blackleaf/error.h"
#include "commands.h"
#include "files.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

struct PageText {
  std::optional<std::string> size;
  std::optional<double> pen_width;
};

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

PageOptions page_for(const LineDrawing& drawing, const PageText& text, const PageSize& size) {
  PageOptions page;
  if (text.pen_width) page.pen_width_mm = *text.pen_width;
  page.width_mm = size.width_mm;
  page.height_mm = size.height_mm;
  if (!size.named || drawing.strokes.empty()) return page;
  // A named page lies down for a picture that is wider than high.
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : drawing.strokes) box.extend(stroke.from).extend(stroke.to);
  if (box.sizes().x() > box.sizes().y()) std::swap(page.width_mm, page.height_mm);
  return page;
}

}  // namespace

int run_draw(Session& session) {
  Label label;
  std::string input, view_text, output;
  std::optional<std::string> format;
  PageText page_text;
  add_octree_input(session.app(), "FILE", input);
  session.app()
      .add_option("--view", view_text,
                  "direction toward the viewer, rounded to 2^-20 of its largest component; +z is up in the picture")
      ->required()
      ->type_name("x,y,z");
  add_output(session.app(), output, "picture: .svg .json .png .pdf; - prints svg or json");
  add_text(session.app(), "--format", format, "FORMAT", "svg or json, for -o -");
  add_text(session.app(), "--size", page_text.size, "SIZE",
           "page: A0 to A6, turned to suit the picture, or WxH in mm (default: the drawing's shape, 180 mm)");
  add_number(session.app(), "--pen-width", page_text.pen_width, true, "width of the lines in mm (default 0.25)");
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf draw bunny.octree --view 3,-4,2 -o bunny.svg");
  if (!session.parse()) return kDone;

  const std::string kind = format_of(output, format);
  if (kind == "json" && (page_text.size || page_text.pen_width))
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} does not apply to JSON, which has no page", page_text.size ? "--size" : "--pen-width"),
                "leave it out");
  const PageSize size = page_text.size ? parse_page_size("--size", *page_text.size) : PageSize{};
  if (const double margins = 2 * PageOptions{}.margin_mm;
      page_text.size && std::min(size.width_mm, size.height_mm) <= margins)
    throw Error(ErrorCode::bad_argument,
                fmt::format("--size is '{}', which the margins of {} mm fill", *page_text.size, margins / 2),
                fmt::format("make both sides longer than {} mm", margins));
  const Eigen::Vector3d direction = parse_vector("--view", view_text);
  if (direction.isZero(0))
    throw Error(ErrorCode::bad_argument, "--view is zero, which is no direction", "give one like 3,-4,2");
  const View view(direction);
  if (output == "-" && session.json())
    throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the picture to a file");
  if (output != "-") check_output(output);

  const Octree octree = read_solid(session, input, label);
  const LineDrawing drawing = session.stage("draw", [&](const Work& work) { return draw(octree, view, work); });
  const PageOptions page = page_for(drawing, page_text, size);
  const double length = drawing.length();
  session.write_stage([&] {
    if (output != "-") return write_drawing(drawing, output, page);
    const std::string picture = (kind == "svg" ? to_svg(drawing, page) : to_json(drawing)) + "\n";
    check_interrupt();
    print_out(picture);
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
