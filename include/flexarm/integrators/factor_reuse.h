#pragma once
/// When Newton's method makes new factors of its tangent, and when it keeps those that it has.

#include <algorithm>

namespace flexarm {

/// New factors are made in the first iterations of a solve, as many as the solves before have shown to pay (stiff parts
/// that turn need more, slow motions none), and later where updates contract slowly.
class FactorReuse {
 public:
  void reset() { fresh_ = 0; }

  /// Starts a solve; whether its first iteration makes new factors. `hold`: there are some of such a system.
  bool begin(bool hold) {
    planned_ = hold ? fresh_ : std::max(fresh_, 1);
    return planned_ > 0;
  }

  /// After the update of an iteration (counted from 0), whose ratio to the one before is `contraction`: whether the
  /// next iteration makes new factors. `compares`: there is one before, of the same equations.
  bool renew(int iteration, bool compares, double contraction) {
    const bool is_slow = compares && contraction > kSlow;
    if (compares && iteration == std::max(planned_, 1)) {  // the first that shows what kept factors are worth
      if (is_slow) fresh_ = std::min(planned_ + 1, kMost);
      if (contraction < kFast) fresh_ = std::max(planned_ - 1, 0);
    }
    return is_slow || iteration + 1 < planned_;
  }

 private:
  /// Contraction above which new factors pay, and below which one iteration less with them is tried.
  static constexpr double kSlow = 0.03, kFast = 1e-3;
  static constexpr int kMost = 3;
  int fresh_ = 0, planned_ = 0;  // first iterations with new factors: of the next solve, of this one
};

}  // namespace flexarm
