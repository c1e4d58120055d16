#include "canvas.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "plot/markup.h"

namespace blackleaf::cli {
namespace {

const char* anchor_name(Canvas::Anchor anchor) {
  switch (anchor) {
    case Canvas::Anchor::middle:
      return "middle";
    case Canvas::Anchor::end:
      return "end";
    default:
      return "start";
  }
}

// At most three decimals of a millimetre; no -0.
std::string number(double value) { return fmt::format("{:.6g}", std::round(value * 1000) / 1000 + 0.0); }

}  // namespace

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view colour, double width_mm) {
  body_ += fmt::format(
      "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"/>\n",
      number(from[0]), number(from[1]), number(to[0]), number(to[1]), colour, number(width_mm));
}

void Canvas::circle(const Eigen::Vector2d& centre, double radius_mm, std::string_view fill, std::string_view stroke,
                    double width_mm) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
                       number(centre[0]), number(centre[1]), number(radius_mm), fill, stroke, number(width_mm));
}

void Canvas::text(const Eigen::Vector2d& at, std::string_view text, double size_mm, Anchor anchor,
                  std::string_view family) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-family=\"{}\" font-size=\"{}\" text-anchor=\"{}\">{}</text>\n",
                       number(at[0]), number(at[1]), family, number(size_mm), anchor_name(anchor),
                       detail::markup_text(text));
}

void Canvas::upward_text(const Eigen::Vector2d& at, std::string_view text, double size_mm) {
  body_ += fmt::format("<g transform=\"translate({} {}) rotate(-90)\">", number(at[0]), number(at[1]));
  this->text({0, 0}, text, size_mm, Anchor::middle);
  body_ += "</g>\n";
}

void Canvas::figure(const Eigen::Vector2d& at, std::string_view svg) {
  std::string inner = without_head(svg);
  // Its size is in millimetres, which are this figure's units.
  [[maybe_unused]] const std::size_t head = inner.find('>');
  for (const char* name : {"width=\"", "height=\""}) {
    const std::size_t unit = inner.find("mm\"", inner.find(name));
    assert(unit < head);
    inner.erase(unit, 2);
  }
  body_ += fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n", number(at[0]), number(at[1]), inner);
}

std::string Canvas::svg() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} "
      "{1}\">\n{2}</svg>\n",
      number(width_), number(height_), body_);
}

std::string Canvas::file() const { return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg(); }

std::string without_head(std::string_view svg) {
  const std::size_t begin = svg.find("<svg ");
  assert(begin != std::string_view::npos);
  return std::string(svg.substr(begin));
}

}  // namespace blackleaf::cli
