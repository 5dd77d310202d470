#pragma once
/// A progress bar on a terminal.

#include <chrono>
#include <string>

namespace flexarm::cli {

/// Draws on the standard error output; draws nothing where that is no terminal.
class ProgressBar {
 public:
  ProgressBar(double begin, double end, bool is_wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows `value` between begin and end; at most ten times a second. Without a label it is a time.
  void show(double value, const std::string& label = {});
  /// Wipes the bar, so that other output can follow.
  void clear();

 private:
  double begin_, end_;
  bool is_visible_, is_drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace flexarm::cli
