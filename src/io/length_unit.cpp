#include "io/length_unit.h"

#include <fmt/format.h>

#include "io/header_text.h"

namespace blackleaf::detail {
namespace {

// The units of a field: between quotes, which NRRD asks for, or blanks.
std::vector<std::string> units_in(std::string_view text) {
  std::vector<std::string> units;
  for (;;) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return units;
    const bool quoted = text[begin] == '"';
    text.remove_prefix(begin + quoted);
    const std::size_t end = std::min(text.find_first_of(quoted ? "\"" : " \t"), text.size());
    units.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

std::optional<double> millimetres(std::string_view unit) {
  for (const std::string_view micron : {"micron", "microns", "micrometer", "micrometre", "um", "\xc2\xb5m", "\xce\xbcm",
                                        "\xb5m", "\\u00B5m", "&#181;m", "&#xB5;m", "&#xb5;m"})
    if (unit == micron) return 1e-3;
  if (unit == "nm" || unit == "nanometer" || unit == "nanometre") return 1e-6;
  if (unit == "mm" || unit == "millimeter" || unit == "millimetre") return 1.0;
  if (unit == "cm" || unit == "centimeter" || unit == "centimetre") return 10.0;
  if (unit == "m" || unit == "meter" || unit == "metre") return 1000.0;
  if (unit == "inch" || unit == "in") return 25.4;
  return std::nullopt;
}

void apply_units(const std::filesystem::path& path, ImageFormat format, ImageGeometry& geometry,
                 const std::function<void(const std::string&)>& warn) {
  if (format == ImageFormat::nifti) return;
  const bool nrrd = format == ImageFormat::nrrd;
  std::vector<std::string> units, of_axes;  // along x, y and z of the world; along the axes of NRRD's array
  bool in_space = false;                    // these axes have directions in a space
  for_each_field(head_of(path, kLongestTextHeader),
                 nrrd ? ":" : "=:", [&](const std::string& name, const std::string& value, std::uint64_t) {
                   if (nrrd && value.starts_with('=')) return true;  // key:=value pairs mean nothing to us
                   const std::string key = nrrd ? lower(name) : name;
                   if (nrrd && key == "units") of_axes = units_in(value);
                   if (nrrd && key == "space units") units = units_in(value);
                   if (!nrrd && key == "DistanceUnits") units.assign(3, value);
                   in_space = in_space || key.starts_with("space ") || key == "space";
                   return nrrd ? !key.empty() : key != "ElementDataFile";
                 });
  if (!in_space && !of_axes.empty()) units = of_axes;  // where there is no space, its axes are the world's
  bool warned = false;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, units.size()); ++i) {
    if (units[i].empty() || units[i].find_first_not_of('?') == std::string::npos || units[i] == "none") continue;
    if (const auto scale = millimetres(units[i])) {
      geometry.origin[i] *= *scale;
      for (std::array<double, 3>& axis : geometry.axes) axis[i] *= *scale;
    } else if (warn && !warned) {
      warn(fmt::format("{}: its unit of length {} is unknown and taken as mm", path.string(), shown(units[i])));
      warned = true;
    }
  }
}

}  // namespace blackleaf::detail
