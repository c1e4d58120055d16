// What programs for microscopes write into the text of a TIFF file.
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/length_unit.h"
#include "io/picture_slices.h"

namespace blackleaf::detail {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// The value on ImageJ's line `key=value`, or in the XML attribute key="value".
std::string_view line(std::string_view text, std::string_view key) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view each = text.substr(at, end - at);
    at = end + 1;
    if (!each.starts_with(key) || each.size() == key.size() || each[key.size()] != '=') continue;
    each.remove_prefix(key.size() + 1);
    while (!each.empty() && (each.back() == '\r' || each.back() == ' ')) each.remove_suffix(1);
    return each;
  }
  return {};
}
std::string_view attribute(std::string_view text, const std::string& key) {
  const std::size_t at = text.find(" " + key + "=\"");
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size() + 3);
  return text.substr(0, text.find('"'));
}

// Whether the text of an OME-TIFF file tells of pages in more than one file.
bool names_several_files(std::string_view text) {
  const std::string_view first = attribute(text, "FileName");
  for (;;) {
    const std::size_t at = text.find(" FileName=\"");
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at);
    if (attribute(text, "FileName") != first) return true;
    text.remove_prefix(1);
  }
}

std::optional<std::array<double, 3>> sound(const std::array<double, 3>& spacing) {
  for (const double side : spacing)
    if (!(side > 1e-12 && side < 1e9)) return std::nullopt;
  return spacing;
}

}  // namespace

std::optional<std::array<double, 3>> spacing_of_description(const std::string& name, const std::string& text,
                                                            std::array<double, 2> resolution, std::size_t pages) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::bad_input, name + ": " + what, remedy);
  };
  const auto several = [&](std::string_view count) { return number(count).value_or(1) > 1; };
  if (text.starts_with("ImageJ=")) {
    if (several(line(text, "channels"))) refuse("has several channels", "split them in ImageJ and save one");
    if (several(line(text, "frames")) && several(line(text, "slices")))
      refuse("is a volume at several times", "save one time of it");
    const double images = number(line(text, "images")).value_or(1);
    if (images > static_cast<double>(pages))
      refuse(fmt::format("tells of {} pictures but has {}", images, pages),
             "ImageJ writes stacks above 4 GB in a way of its own: save it as an image sequence");
    const auto unit = millimetres(line(text, "unit"));
    const auto spacing = number(line(text, "spacing"));
    if (!unit || !spacing || several(line(text, "frames"))) return std::nullopt;
    return sound({*unit / resolution[0], *unit / resolution[1], *unit * std::abs(*spacing)});
  }
  if (text.find("<OME") == std::string::npos) return std::nullopt;
  if (several(attribute(text, "SizeC"))) refuse("has several channels", "split them first");
  if (several(attribute(text, "SizeT"))) refuse("is a volume at several times", "save one time of it");
  if (const double slices = number(attribute(text, "SizeZ")).value_or(1);
      slices > static_cast<double>(pages) && !names_several_files(text))
    refuse(fmt::format("tells of {} slices but has {} pages", slices, pages), "get it again from its source");
  std::array<double, 3> spacing{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string key = std::string("PhysicalSize") + "XYZ"[i];
    const auto side = number(attribute(text, key));
    const std::string_view unit = attribute(text, key + "Unit");
    const auto scale = unit.empty() ? std::optional(1e-3) : millimetres(unit);  // OME's default is the micrometre
    if (!side || !scale) return std::nullopt;
    spacing[i] = *side * *scale;
  }
  return sound(spacing);
}

}  // namespace blackleaf::detail
