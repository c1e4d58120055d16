#include "blackleaf/drawing_file.h"

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/atomic_write.h"
#include "io/image_io.h"

namespace blackleaf {
namespace {

[[noreturn]] void refuse_suffix(const std::filesystem::path& path, const std::string& suffix) {
  throw Error(ErrorCode::bad_argument, fmt::format("{}: drawings are not written as '{}'", path.string(), suffix),
              "use .svg, .pdf, .png, .hpgl, .dxf or .json");
}

}  // namespace

void write_picture(const Picture& picture, const std::filesystem::path& path, double dots_per_inch) {
  const std::string suffix = detail::image_suffix(path);
  if (suffix == ".svg")
    detail::write_atomically(path, to_svg(picture));
  else if (suffix == ".json")
    detail::write_atomically(path, to_json(picture));
  else if (suffix == ".hpgl" || suffix == ".plt")
    detail::write_atomically(path, to_hpgl(picture));
  else if (suffix == ".dxf")
    detail::write_atomically(path, to_dxf(picture));
  else if (suffix == ".png")
    detail::write_atomically(path, to_png(picture, dots_per_inch));
  else if (suffix == ".pdf")
    detail::write_atomically(path, to_pdf(picture));
  else
    refuse_suffix(path, suffix);
}

void write_drawing(const LineDrawing& drawing, const std::filesystem::path& path, const PageOptions& page) {
  if (detail::image_suffix(path) == ".json")
    detail::write_atomically(path, to_json(drawing));
  else
    write_picture(lay_out(drawing, page), path, page.dots_per_inch);
}

}  // namespace blackleaf
