#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace blackleaf::cli {
namespace {

// "about 12 s left"; nothing while too little is done to tell, and nothing when all is.
std::string time_left(double seconds, double done) {
  constexpr double kTooLittle = 0.005;
  if (done < kTooLittle || done >= 1) return {};
  const double left = std::ceil(seconds * (1 - done) / done);
  if (left < 100) return fmt::format("  about {:.0f} s left", left);
  if (left < 100 * 60) return fmt::format("  about {:.0f} min left", std::ceil(left / 60));
  return fmt::format("  about {:.0f} h left", std::ceil(left / 3600));
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool wanted)
    : label_(std::move(label)),
      wanted_(wanted && isatty(STDERR_FILENO) == 1),
      next_(start_ + std::chrono::seconds(1)) {}

void ProgressBar::show(double fraction) {
  if (!wanted_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  constexpr int kWidth = 40;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(done * kWidth);
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  // What is left of a longer line is erased.
  fmt::print(stderr, "\r{:<8} [{}{}] {:3.0f}%{}\x1b[K", label_, std::string(full, '#'), std::string(kWidth - full, '.'),
             100 * done, time_left(elapsed.count(), done));
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!std::exchange(drawn_, false)) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
}

}  // namespace blackleaf::cli
