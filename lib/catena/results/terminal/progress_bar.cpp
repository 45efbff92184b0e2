#include "catena/results/terminal/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace catena {
namespace {

constexpr int width = 30;
constexpr auto period = std::chrono::milliseconds(100);
// Runs that end within half a second show no bar.
constexpr auto patience = std::chrono::milliseconds(500);

}  // namespace

ProgressBar::ProgressBar(bool wanted)
    : visible_(wanted && ::isatty(STDERR_FILENO) == 1), next_(std::chrono::steady_clock::now() + patience) {}

std::string ProgressBar::text(std::string_view label, double fraction) {
  fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int full = static_cast<int>(fraction * width);
  const std::string percent = std::to_string(static_cast<int>(fraction * 100));
  std::string text(label);
  text += " [" + std::string(static_cast<std::size_t>(full), '#');
  text += std::string(static_cast<std::size_t>(width - full), '.') + "] ";
  return text + std::string(3 - percent.size(), ' ') + percent + " %";
}

void ProgressBar::update(std::string_view label, double fraction) {
  if (!visible_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + period;
  drawn_ = true;
  std::fprintf(stderr, "\r%s\033[K", text(label, fraction).c_str());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace catena
