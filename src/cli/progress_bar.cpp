#include "cli/progress_bar.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

namespace flexarm::cli {
namespace {

constexpr int kWidth = 40;  // characters
constexpr std::chrono::milliseconds kInterval{100};
constexpr std::chrono::seconds kFirstLine{2};

}  // namespace

ProgressBar::ProgressBar(double begin, double end, bool is_wanted, bool lines)
    : begin_(begin),
      end_(end),
      is_visible_(is_wanted && isatty(STDERR_FILENO)),
      has_lines_(is_wanted && lines && !is_visible_),
      start_(Clock::now()),
      next_(has_lines_ ? start_ + kFirstLine : start_) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(double value, const std::string& label) {
  if (!is_visible_ && !has_lines_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  const double part = end_ > begin_ ? std::clamp((value - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const std::string text =
      fmt::format("{:3.0f} %  {}", 100 * part, label.empty() ? fmt::format("t = {:.4g} s", value) : label);
  if (has_lines_) return write_line(text);
  next_ = now + kInterval;
  const int filled = static_cast<int>(part * kWidth);
  fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(filled, '#'), std::string(kWidth - filled, ' '), text);
  std::fflush(stderr);
  is_drawn_ = true;
}

void ProgressBar::write_line(const std::string& text) {
  const Clock::duration gone = Clock::now() - start_;
  fmt::print(stderr, "flexarm: after {:.0f} s: {}\n", std::chrono::duration<double>(gone).count(), text);
  std::fflush(stderr);
  next_ = start_ + 2 * gone;
}

void ProgressBar::clear() {
  if (is_drawn_) fmt::print(stderr, "\r\033[K");
  is_drawn_ = false;
}

}  // namespace flexarm::cli
