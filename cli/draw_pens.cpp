#include "draw_pens.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "blackleaf/error.h"

namespace blackleaf::cli {
namespace {

// Colours that differ for everybody on white paper (Okabe and Ito 2008, without their yellow), after black.
constexpr std::array<std::pair<std::string_view, PenColour>, 7> kColours{{{"black", {0, 0, 0}},
                                                                          {"blue", {0, 114, 178}},
                                                                          {"red", {213, 94, 0}},
                                                                          {"green", {0, 158, 115}},
                                                                          {"purple", {204, 121, 167}},
                                                                          {"orange", {230, 159, 0}},
                                                                          {"sky", {86, 180, 233}}}};

std::optional<PenColour> colour_in(std::string_view text) {
  for (const auto& [name, colour] : kColours)
    if (name == text) return colour;
  if ((text.size() != 4 && text.size() != 7) || text[0] != '#') return std::nullopt;
  std::array<std::uint8_t, 6> digits{};
  for (std::size_t i = 1; i < text.size(); ++i) {
    const std::size_t value = std::string_view("0123456789abcdef").find(static_cast<char>(text[i] | 0x20));
    if (value == std::string_view::npos) return std::nullopt;
    digits[i - 1] = static_cast<std::uint8_t>(value);
  }
  const auto byte = [](unsigned high, unsigned low) { return static_cast<std::uint8_t>(16 * high + low); };
  if (text.size() == 4)
    return PenColour{byte(digits[0], digits[0]), byte(digits[1], digits[1]), byte(digits[2], digits[2])};
  return PenColour{byte(digits[0], digits[1]), byte(digits[2], digits[3]), byte(digits[4], digits[5])};
}

Pen parse_pen(const std::string& text, double width) {
  const std::size_t colon = text.find(':');
  const auto colour = colour_in(std::string_view(text).substr(0, colon));
  if (colon != std::string::npos) width = parse_number("--pen", text.substr(colon + 1));
  if (!colour || !(width > 0))
    throw Error(ErrorCode::bad_argument, fmt::format("--pen is '{}', which is no pen", text),
                "write a colour (#rrggbb, black, blue, red, green, purple, orange or sky) and perhaps :width in mm, "
                "like red:0.35");
  return {*colour, width, {}};
}

}  // namespace

void PenArguments::add_to(CLI::App& app) {
  add_number(app, "--pen-width", pen_width_, true, "width of the lines in mm (default 0.25)");
  add_text(app, "--pen", pen_, "COLOUR[:MM]", "a colour like #d55e00 or blue, perhaps with a width in mm");
}

Pen PenArguments::pen() const {
  const double width = pen_width_.value_or(Pen{}.width_mm);
  return pen_ ? parse_pen(*pen_, width) : Pen{.width_mm = width};
}

}  // namespace blackleaf::cli
