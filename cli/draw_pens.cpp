#include "draw_pens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
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

// COLOUR[:MM], perhaps after LABEL=.
struct ParsedPen {
  std::optional<std::uint32_t> label;
  Pen pen;
};
ParsedPen parse_pen(const std::string& text, double width) {
  ParsedPen parsed;
  std::string_view rest = text;
  if (const std::size_t equals = text.find('='); equals != std::string::npos) {
    parsed.label = static_cast<std::uint32_t>(
        parse_integer("--pen", text.substr(0, equals), 0, std::numeric_limits<std::uint32_t>::max()));
    rest.remove_prefix(equals + 1);
  }
  const std::size_t colon = rest.find(':');
  const auto colour = colour_in(rest.substr(0, colon));
  if (colon != std::string_view::npos) width = parse_number("--pen", std::string(rest.substr(colon + 1)));
  if (!colour || !(width > 0))
    throw Error(ErrorCode::bad_argument, fmt::format("--pen is '{}', which is no pen", text),
                "write a colour (#rrggbb, black, blue, red, green, purple, orange or sky) and perhaps :width in mm, "
                "like red:0.35");
  parsed.pen = {*colour, width, {}};
  return parsed;
}

// A distance of hatch lines: "1.2", "1.2mm", "4voxels".
struct Spacing {
  double value = 1;
  bool voxels = false;
};
Spacing parse_spacing(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789.");
  const std::string unit = end == std::string::npos ? text : text.substr(end + 1);
  const double value = parse_number("--hatch-spacing", text.substr(0, end == std::string::npos ? 0 : end + 1));
  const bool voxels = unit == "voxels" || unit == "voxel";
  if (!(value > 0) || !(voxels || unit.empty() || unit == "mm"))
    throw Error(ErrorCode::bad_argument, fmt::format("--hatch-spacing is '{}', which is no distance", text),
                "write it like 1.2mm or 4voxels");
  return {value, voxels};
}

constexpr double kHatchMm = 1, kHatchVoxels = 4;  // unless told otherwise
constexpr double kCutHatch = 0.7;                 // cut faces are hatched so much closer
constexpr double kOutlineGap = 1.0 / 32;          // of the universe's side
constexpr double kThin = 0.6;                     // hidden lines and hatching beside visible lines

}  // namespace

void PenArguments::add_to(App& app) {
  add_number(app, "--pen-width", pen_width_, true, "width of the lines in mm (default 0.25)");
  app.add_option("--pen", pens_,
                 "pen of the first file, the second ... (of a single file with labels: of the labels in turn), or of a "
                 "label; a colour like #d55e00 or blue, perhaps with a width in mm; repeatable")
      ->type_name("[LABEL=]COLOUR[:MM]")
      ->expected(1)
      ->repeatable();
  add_text(app, "--hidden", hidden_, "dashed|none|only", "hidden lines: dashed, not at all (default), or nothing else");
  add_number(app, "--outline-width", outline_width_, true,
             "outlines, which have nothing close behind them, in this width in mm");
  add_number(app, "--outline-gap", outline_gap_, true,
             "of --outline-width: what is less than so many voxels behind is close (default: 1/32 of the universe)");
  app.add_flag("--hatch", hatch_, "hatch faces by the direction in which they look");
  add_text(app, "--hatch-spacing", hatch_spacing_, "N[mm|voxels]",
           "between hatch lines (default 1mm, without a page 4voxels); cut faces have 0.7 of it");
}

void PenArguments::check(bool in_voxels, bool cut) const {
  const SceneOptions options = lines(1);
  for (const std::string& text : pens_) static_cast<void>(parse_pen(text, 1));
  if (outline_gap_ && !outline_width_)
    throw Error(ErrorCode::bad_argument, "--outline-gap belongs to --outline-width", "add it or leave this out");
  if (!options.visible && (hatch_ || outline_width_))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--hidden only leaves nothing for {}", hatch_ ? "--hatch" : "--outline-width"),
                "use --hidden dashed");
  if (!hatch_spacing_) return;
  if (!hatch_ && !cut)
    throw Error(ErrorCode::bad_argument, "--hatch-spacing belongs to --hatch or --cut", "add one or leave it out");
  if (!parse_spacing(*hatch_spacing_).voxels && in_voxels)
    throw Error(ErrorCode::bad_argument,
                fmt::format("--hatch-spacing is '{}', and JSON has no page and no mm", *hatch_spacing_),
                "give it in voxels, like 4voxels");
}

void PenArguments::check_perspective() const {
  if (hatch_ || hatch_spacing_)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} is for --view and --sheet, not for --eye", hatch_ ? "--hatch" : "--hatch-spacing"),
                "leave it out");
  if (outline_gap_)
    throw Error(ErrorCode::bad_argument, "--outline-gap is for --view and --sheet, not for --eye",
                "leave it out: outlines stand out against the background then");
}

void PenArguments::check(const NamedScene& scene) const {
  const std::size_t files = scene.solids.back().file + 1;
  const std::size_t most = files == 1 && scene.solids.front().label ? scene.solids.size() : files;
  std::size_t plain = 0;
  for (const std::string& text : pens_) {
    const ParsedPen parsed = parse_pen(text, 1);
    if (!parsed.label) ++plain;
    if (parsed.label && std::none_of(scene.solids.begin(), scene.solids.end(),
                                     [&](const NamedScene::Solid& solid) { return solid.label == parsed.label; }))
      throw Error(ErrorCode::bad_argument, fmt::format("--pen {}: no solid has label {}", text, *parsed.label),
                  "blackleaf info tells which labels there are");
  }
  if (plain > most)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("--pen is given {} times for {}", plain, most == 1 ? "one solid" : fmt::format("{} solids", most)),
        "give one for each at most");
}

SceneOptions PenArguments::lines(std::int32_t side) const {
  SceneOptions options;
  options.outline = outline_width_.has_value();
  options.outline_gap = outline_gap_.value_or(std::max(1.0, kOutlineGap * side));
  if (!hidden_ || *hidden_ == "none") return options;
  if (*hidden_ != "dashed" && *hidden_ != "only")
    throw Error(ErrorCode::bad_argument, fmt::format("--hidden is '{}', which is unknown", *hidden_),
                "use dashed, none or only");
  options.hidden = true;
  options.visible = *hidden_ == "dashed";
  return options;
}

HatchOptions PenArguments::hatching(std::optional<double> mm_per_voxel, bool cut) const {
  const Spacing spacing = hatch_spacing_ ? parse_spacing(*hatch_spacing_)
                          : mm_per_voxel ? Spacing{kHatchMm, false}
                                         : Spacing{kHatchVoxels, true};
  const double voxels = spacing.voxels ? spacing.value : spacing.value / mm_per_voxel.value_or(1);
  HatchOptions options;
  options.faces = hatch_ ? voxels : 0;
  options.cuts = cut ? kCutHatch * voxels : 0;
  return options;
}

Pen PenArguments::pen(const NamedScene& scene, std::size_t solid) const {
  const double width = pen_width_.value_or(Pen{}.width_mm);
  const NamedScene::Solid& what = scene.solids[solid];
  const bool several_files = scene.solids.back().file > 0;
  const std::size_t turn = several_files ? what.file : what.label ? solid : 0;
  std::size_t plain = 0;
  std::optional<Pen> found;
  for (const std::string& text : pens_) {
    const ParsedPen parsed = parse_pen(text, width);
    if (parsed.label ? parsed.label == what.label : plain++ == turn) {
      found = parsed.pen;
      if (parsed.label) break;
    }
  }
  if (found) return *found;
  const std::size_t colour = several_files ? what.file + (what.label ? solid : 0) : turn;
  return {kColours[colour % kColours.size()].second, width, {}};
}

std::vector<Layer> PenArguments::layers(const NamedScene& scene, std::vector<SceneLines> lines) const {
  struct Kind {
    LineKind kind;
    const char* name;
  };
  constexpr std::array<Kind, 5> kLowestFirst{{{LineKind::hatch, "hatch"},
                                              {LineKind::cut, "cut"},
                                              {LineKind::hidden, "hidden"},
                                              {LineKind::visible, "visible"},
                                              {LineKind::outline, "outline"}}};
  std::vector<Layer> result;
  for (const Kind& kind : kLowestFirst)
    for (SceneLines& part : lines) {
      if (part.kind != kind.kind) continue;
      Pen with = pen(scene, part.solid);
      if (kind.kind == LineKind::outline) with.width_mm = outline_width_.value_or(with.width_mm);
      if (kind.kind == LineKind::hatch || kind.kind == LineKind::cut) with.width_mm *= kThin;
      if (kind.kind == LineKind::hidden) {
        // Dashes of ISO 128's proportions would be longer than most edges of voxels; these are shorter.
        with.dashes_mm = {6 * with.width_mm, 4 * with.width_mm};
        with.width_mm *= kThin;
      }
      const std::string& name = scene.solids[part.solid].name;
      result.push_back({name.empty() ? kind.name : name + " " + kind.name, std::move(with), polylines(part.strokes)});
      std::vector<Stroke>().swap(part.strokes);
    }
  if (result.empty()) result.push_back({"visible", pen(scene, 0), {}});
  return result;
}

}  // namespace blackleaf::cli
