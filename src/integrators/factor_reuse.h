#pragma once
/// When Newton's method makes new factors of its tangent, and when it keeps those that it has.

#include <algorithm>
#include <cmath>

namespace flexarm {

/// New factors are made in the first iterations of a solve, as many as the solves before have shown to pay (stiff parts
/// that turn need more, slow motions none), and later where updates contract slowly.
class FactorReuse {
 public:
  /// `cost`: of an iteration with new factors over that of one with kept ones, see TangentBackend. New factors square
  /// the error, kept ones contract it by a rate 10^-L. In a typical solve an iteration more with new ones saves kept
  /// ones for about 7.5 digits, one less costs kept ones for 15 digits at the rate L.
  explicit FactorReuse(double cost) : slow_(std::pow(10.0, -7.5 / cost)), fast_(std::pow(10.0, -15.0 / cost)) {}

  void reset() { fresh_ = unjudged_ = 0; }

  /// Starts a solve; whether its first iteration makes new factors. `hold`: there are some of such a system.
  bool begin(bool hold) {
    if (++unjudged_ > kPatience) fresh_ = std::max(fresh_ - 1, 0), unjudged_ = 0;
    planned_ = hold ? fresh_ : std::max(fresh_, 1);
    return planned_ > 0;
  }

  /// After the update of an iteration (counted from 0), by kept factors or new ones, whose ratio to the one before is
  /// `contraction`: whether the next iteration makes new factors. `compares`: there is one before, of the same
  /// equations, and the update is more than round-off.
  bool renew(int iteration, bool was_kept, bool compares, double contraction) {
    const bool is_slow = compares && contraction > slow_;
    if (compares && was_kept) {
      // The first shows best what kept factors are worth, but may profit from an error that the new ones left small.
      if (iteration == std::max(planned_, 1) && contraction < fast_) fresh_ = std::max(planned_ - 1, 0);
      if (is_slow) fresh_ = std::min(planned_ + 1, kMost);
      unjudged_ = 0;
    }
    return is_slow || iteration + 1 < planned_;
  }

 private:
  static constexpr int kMost = 3;
  static constexpr int kPatience = 8;  // solves without kept factors after which some are tried
  double slow_, fast_;                 // contraction above which new factors pay, and below which fewer are tried
  int fresh_ = 0, planned_ = 0;        // first iterations with new factors: of the next solve, of this one
  int unjudged_ = 0;                   // solves since kept factors have shown what they are worth
};

}  // namespace flexarm
