#include "catena/results/terminal/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace catena {
namespace {

constexpr int width = 30;
constexpr auto period = std::chrono::milliseconds(100);
// Runs that end within half a second show no bar.
constexpr auto patience = std::chrono::milliseconds(500);

}  // namespace

std::optional<double> TimeLeft::after(double now, double fraction) {
  if (!std::isfinite(fraction)) return {};
  if (!begin_) begin_ = older_ = newer_ = {now, fraction};
  // The newer mark becomes the older one when as much time has passed since as before it.
  if (now - newer_.time >= newer_.time - begin_->time) {
    older_ = newer_;
    newer_ = {now, fraction};
  }
  const double time = now - older_.time, done = fraction - older_.fraction;
  // A second, for the pace of a few moments is none.
  if (now - begin_->time < 1 || !(done > 0)) return {};
  return time * (1 - fraction) / done;
}

std::string TimeLeft::text(double seconds) {
  const double whole = std::ceil(seconds), minutes = std::ceil(seconds / 60);
  // A century, beyond which there is no plan.
  if (!(seconds < 3.2e9)) return "years left";
  if (whole < 100) return std::to_string(static_cast<int>(whole)) + " s left";
  if (minutes < 100) return std::to_string(static_cast<int>(minutes)) + " min left";
  const auto all = static_cast<std::int64_t>(minutes);
  return std::to_string(all / 60) + " h " + std::to_string(all % 60) + " min left";
}

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
  if (label != label_) {
    label_ = label;
    left_ = {};
  }
  const std::optional<double> left =
      left_.after(std::chrono::duration<double>(now.time_since_epoch()).count(), fraction);
  std::fprintf(stderr, "\r%s%s\033[K", text(label, fraction).c_str(),
               left ? ("  " + TimeLeft::text(*left)).c_str() : "");
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace catena
