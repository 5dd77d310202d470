#include "cli/progress_bar.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

namespace flexarm::cli {
namespace {

constexpr int kWidth = 40;  // characters
constexpr std::chrono::milliseconds kInterval{100};

}  // namespace

ProgressBar::ProgressBar(double begin, double end, bool is_wanted)
    : begin_(begin),
      end_(end),
      is_visible_(is_wanted && isatty(STDERR_FILENO)),
      next_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(double value, const std::string& label) {
  if (!is_visible_) return;
  const std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + kInterval;
  const double part = end_ > begin_ ? std::clamp((value - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const int filled = static_cast<int>(part * kWidth);
  fmt::print(stderr, "\r[{}{}] {:3.0f} %  {}\033[K", std::string(filled, '#'), std::string(kWidth - filled, ' '),
             100 * part, label.empty() ? fmt::format("t = {:.4g} s", value) : label);
  std::fflush(stderr);
  is_drawn_ = true;
}

void ProgressBar::clear() {
  if (is_drawn_) fmt::print(stderr, "\r\033[K");
  is_drawn_ = false;
}

}  // namespace flexarm::cli
