// Options as text: numbers, vectors, rotations and ranges as the user types them. Every function throws
// Error(bad_argument) that names the option, quotes what was typed and shows the right form.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app.h"
#include "blackleaf/motion.h"

namespace blackleaf::cli {

/// A finite number.
double parse_number(const std::string& option, const std::string& text);
/// A whole number in [low, high].
std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high);
/// `x,y,z`: exactly three finite numbers, no spaces.
Eigen::Vector3d parse_vector(const std::string& option, const std::string& text);
/// `a,b,...`: one finite number or more.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);
/// `x,y,z`: exactly three whole numbers.
std::array<std::int64_t, 3> parse_integer_vector(const std::string& option, const std::string& text);
/// `x,y,z:degrees`, a rotation about the corner.
Motion parse_rotation(const std::string& option, const std::string& text);

/// `LO:HI`; either side may be empty, not both.
struct Range {
  std::optional<double> low, high;
};
Range parse_range(const std::string& option, const std::string& text);

/// A page: A0 to A6, or WxH in millimetres.
struct PageSize {
  double width_mm = 0, height_mm = 0;
  bool named = false;  // a named page may be turned to suit the picture
};
PageSize parse_page_size(const std::string& option, const std::string& text);

/// Adds an option that takes a whole number in [low, high].
Option* add_integer(App& app, const std::string& name, std::optional<int>& target, int low, int high,
                    const std::string& description);
/// Adds an option that takes a finite number; above zero, if `positive`.
Option* add_number(App& app, const std::string& name, std::optional<double>& target, bool positive,
                   const std::string& description);
/// Adds an option that takes any text.
Option* add_text(App& app, const std::string& name, std::optional<std::string>& target, const std::string& type,
                 const std::string& description);

}  // namespace blackleaf::cli
