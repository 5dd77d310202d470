#pragma once
/// A progress bar on a terminal.

#include <chrono>
#include <string>

namespace flexarm::cli {

/// Draws on standard error; draws nothing if standard error is not a terminal.
class ProgressBar {
 public:
  ProgressBar(double begin, double end, bool is_wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows `value` between begin and end, at most ten times a second. Without a label, the value is shown as a time.
  void show(double value, const std::string& label = {});
  /// Removes the bar, so that other output can follow.
  void clear();

 private:
  double begin_, end_;
  bool is_visible_, is_drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace flexarm::cli
