#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace blackleaf::cli {

ProgressBar::ProgressBar(std::string label, bool wanted)
    : label_(std::move(label)),
      wanted_(wanted && isatty(STDERR_FILENO) == 1),
      next_(Clock::now() + std::chrono::seconds(1)) {}

void ProgressBar::show(double fraction) {
  if (!wanted_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  constexpr int kWidth = 40;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(done * kWidth);
  fmt::print(stderr, "\r{:<8} [{}{}] {:3.0f}%", label_, std::string(full, '#'), std::string(kWidth - full, '.'),
             100 * done);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!std::exchange(drawn_, false)) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
}

}  // namespace blackleaf::cli
