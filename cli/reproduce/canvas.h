// Canvas: figures of lines, circles, text and other figures, as SVG in millimetres, y downward.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace blackleaf::cli {

class Canvas {
 public:
  enum class Anchor { start, middle, end };

  Canvas(double width_mm, double height_mm) : width_(width_mm), height_(height_mm) {}

  /// Colours are SVG's, e.g. "black" or "none".
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view colour = "black",
            double width_mm = 0.25);
  void circle(const Eigen::Vector2d& centre, double radius_mm, std::string_view fill, std::string_view stroke = "black",
              double width_mm = 0.25);
  /// `text` is plain; `size_mm` is the font's.
  void text(const Eigen::Vector2d& at, std::string_view text, double size_mm = 3.5, Anchor anchor = Anchor::start,
            std::string_view family = "serif");
  /// Text that runs upward.
  void upward_text(const Eigen::Vector2d& at, std::string_view text, double size_mm = 3.5);
  /// A whole SVG text with a size in millimetres, its upper left corner at (x, y).
  void figure(const Eigen::Vector2d& at, std::string_view svg);

  /// <svg ...>...</svg>, to stand in a page.
  std::string svg() const;
  /// The same as a file of its own.
  std::string file() const;

 private:
  double width_, height_;
  std::string body_;
};

/// The part of an SVG file from its <svg ...> on, to stand in a page.
std::string without_head(std::string_view svg);

}  // namespace blackleaf::cli
