#include "options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "blackleaf/error.h"

namespace blackleaf::cli {
namespace {

// All of `text` as a number; a leading + is allowed.
template <class T>
std::optional<T> number_in(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> finite_in(std::string_view text) {
  const auto value = number_in<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

[[noreturn]] void refuse(const std::string& option, std::string_view text, std::string_view what,
                         const std::string& remedy) {
  throw Error(ErrorCode::bad_argument, fmt::format("{} is '{}', which is not {}", option, text, what), remedy);
}

// Whether the number that a text writes is the double that was made of it. Only whole numbers beyond 2^53 are looked
// at: below, a double is as near as anybody can ask for; beyond, it may be another whole number.
bool is_itself(std::string_view text, double value) {
  if (std::abs(value) < 0x1p53 || std::abs(value) > 0x1p64) return true;  // no value lies beyond the latter
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  const std::string_view mantissa = text.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  std::string digits(mantissa.substr(0, point));
  digits += mantissa.substr(std::min(point + 1, mantissa.size()));
  // What is added are at most the twenty digits of such a number.
  auto ahead = static_cast<std::int64_t>(point);
  if (e < text.size()) ahead += number_in<std::int64_t>(text.substr(e + 1)).value_or(0);
  while (static_cast<std::int64_t>(digits.size()) < ahead) digits += '0';
  const auto split = digits.begin() + static_cast<std::ptrdiff_t>(std::max<std::int64_t>(ahead, 0));
  if (std::any_of(split, digits.end(), [](char c) { return c != '0'; })) return false;
  digits.erase(split, digits.end());
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  return digits == fmt::format("{:.0f}", std::abs(value));
}

// A bound of values, finite and kept exactly.
std::optional<double> bound_in(const std::string& option, std::string_view text) {
  const auto value = finite_in(text);
  if (value && !is_itself(text, *value))
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} has {}, a number beyond 2^53 that is not kept exactly", option, text),
                fmt::format("the nearest that is: {:.0f}", *value));
  return value;
}

}  // namespace

double parse_number(const std::string& option, const std::string& text) {
  const auto value = finite_in(text);
  if (!value) refuse(option, text, "a finite number", "write it like 0.75");
  return *value;
}

std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high) {
  const auto value = number_in<std::int64_t>(text);
  if (!value || *value < low || *value > high)
    refuse(option, text, fmt::format("a whole number from {} to {}", low, high),
           fmt::format("choose one from {} to {}", low, high));
  return *value;
}

Eigen::Vector3d parse_vector(const std::string& option, const std::string& text) {
  const auto parts = split(text, ',');
  Eigen::Vector3d vector;
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto value = finite_in(parts[i]);
    good = value.has_value();
    if (good) vector[static_cast<Eigen::Index>(i)] = *value;
  }
  if (!good) refuse(option, text, "three finite numbers", "write x,y,z without spaces, like 1,0,-2.5");
  return vector;
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    const auto value = bound_in(option, part);
    if (!value) refuse(option, text, "a list of finite numbers", "write a,b,... without spaces, like -200,100,300");
    numbers.push_back(*value);
  }
  return numbers;
}

std::array<std::int64_t, 3> parse_integer_vector(const std::string& option, const std::string& text) {
  const auto parts = split(text, ',');
  std::array<std::int64_t, 3> vector{};
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto value = number_in<std::int64_t>(parts[i]);
    good = value.has_value();
    if (good) vector[i] = *value;
  }
  if (!good) refuse(option, text, "three whole numbers", "write x,y,z without spaces, like 1,0,-2");
  return vector;
}

Motion parse_rotation(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto degrees = colon == std::string::npos ? std::nullopt : finite_in(std::string_view(text).substr(colon + 1));
  if (!degrees) refuse(option, text, "an axis and an angle", "write x,y,z:degrees without spaces, like 0,0,1:90");
  const Eigen::Vector3d axis = parse_vector(option, text.substr(0, colon));
  if (axis.isZero(0)) refuse(option, text, "a rotation: its axis is zero", "give an axis like 0,0,1");
  return Motion::rotation_degrees(axis, *degrees);
}

Range parse_range(const std::string& option, const std::string& text) {
  const std::string form = "write LO:HI, one side may be empty, like 300: or -100:200";
  const auto sides = split(text, ':');
  if (sides.size() != 2 || (sides[0].empty() && sides[1].empty())) refuse(option, text, "a range", form);
  Range range;
  if (!sides[0].empty() && !(range.low = bound_in(option, sides[0])))
    refuse(option, text, "a range of finite numbers", form);
  if (!sides[1].empty() && !(range.high = bound_in(option, sides[1])))
    refuse(option, text, "a range of finite numbers", form);
  if (range.low && range.high && *range.low > *range.high)
    refuse(option, text, "a range: its low end is above its high end", "swap the two");
  return range;
}

PageSize parse_page_size(const std::string& option, const std::string& text) {
  if (text.size() == 2 && (text[0] == 'A' || text[0] == 'a') && text[1] >= '0' && text[1] <= '6') {
    // ISO 216: halve the longer side, rounding down, starting from A0.
    int width = 841, height = 1189;
    for (char size = '0'; size < text[1]; ++size) {
      const int half = height / 2;
      height = width;
      width = half;
    }
    return {double(width), double(height), true};
  }
  const auto sides = split(text, 'x');
  const auto width = sides.size() == 2 ? finite_in(sides[0]) : std::nullopt;
  const auto height = sides.size() == 2 ? finite_in(sides[1]) : std::nullopt;
  // The upper limit keeps pictures within what PDF viewers and PNG readers can show.
  constexpr double kLongest = 5000;
  if (!width || !height || *width <= 0 || *height <= 0 || *width > kLongest || *height > kLongest)
    refuse(option, text, "a page size", "write A0 to A6, or width x height up to 5000 mm like 200x150");
  return {*width, *height, false};
}

Option* add_integer(App& app, const std::string& name, std::optional<int>& target, int low, int high,
                    const std::string& description) {
  return app
      .add_option_function(
          name,
          [&target, name, low, high](const std::string& text) {
            target = static_cast<int>(parse_integer(name, text, low, high));
          },
          description)
      ->type_name("N");
}

Option* add_number(App& app, const std::string& name, std::optional<double>& target, bool positive,
                   const std::string& description) {
  return app
      .add_option_function(
          name,
          [&target, name, positive](const std::string& text) {
            target = parse_number(name, text);
            if (positive && *target <= 0) refuse(name, text, "above zero", "give a number above zero");
          },
          description)
      ->type_name("F");
}

Option* add_text(App& app, const std::string& name, std::optional<std::string>& target, const std::string& type,
                 const std::string& description) {
  return app
      .add_option_function(
          name, [&target](const std::string& text) { target = text; }, description)
      ->type_name(type);
}

}  // namespace blackleaf::cli
