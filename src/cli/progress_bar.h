#pragma once
/// Shows what takes long on standard error: a progress bar on a terminal, or lines of text.

#include <chrono>
#include <string>

namespace flexarm::cli {

/// If standard error is not a terminal, there is no bar.
class ProgressBar {
 public:
  /// `lines`: if there is no bar, writes a line after two seconds, and then each time when the time has doubled. For
  /// what may take much longer than the user expects.
  ProgressBar(double begin, double end, bool is_wanted, bool lines = false);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows `value` between begin and end, at most ten times a second. Without a label, the value is shown as a time.
  void show(double value, const std::string& label = {});
  /// Removes the bar, so that other output can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void write_line(const std::string& text);

  double begin_, end_;
  bool is_visible_, is_drawn_ = false, has_lines_;
  Clock::time_point start_, next_;
};

}  // namespace flexarm::cli
