// Progress bar: one line on a terminal, rewritten in place, for anything that takes over a second.
#pragma once

#include <chrono>
#include <string>

namespace blackleaf::cli {

class ProgressBar {
 public:
  /// Draws nothing unless `wanted` and standard error is a terminal.
  ProgressBar(std::string label, bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows the fraction done, in [0, 1], and how long the rest will take at the speed so far; at most ten times a
  /// second, not at all in the first second.
  void show(double fraction);
  /// Takes the bar off the screen.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool wanted_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace blackleaf::cli
