#pragma once
/// Numbers that vanish where efforts have kinks, for explicit schemes. (docs/notes/explicit.md 3)

#include <iterator>
#include <vector>

#include "joints/joint_forces.h"

namespace flexarm {

/// How far quantities are from both of their bounds, at the instant that was evaluated last: the demand of a motor from
/// its limits, an effort of the scene from its limit, the twist of a gear from the ends of its play, and the rate of
/// what rubs from those between which smooth friction reverses.
class ExplicitMargins {
 public:
  static constexpr int kNone = -1;

  /// Adds a quantity. Returns its place.
  int add() {
    numbers_.resize(numbers_.size() + 2);
    return static_cast<int>(numbers_.size()) - 2;
  }
  /// Does nothing if the place is kNone.
  void set(int place, double quantity, double lowest, double highest) {
    if (place == kNone) return;
    numbers_[place] = highest - quantity;
    numbers_[place + 1] = quantity - lowest;
  }
  /// The same for the rate of something with smooth friction. Steps resolve a reversal if they end at all these rates.
  int add_reversal() {
    const int first = add();
    for (std::size_t level = 1; level < std::size(kReversal); ++level) add();
    reversals_.push_back({first, 0});
    return static_cast<int>(reversals_.size()) - 1;
  }
  void set_reversal(int place, double rate) {
    if (place != kNone) reversals_[place].rate = rate;
  }
  /// All numbers of the instant that was set last. Those of reversals are computed here, since only ends of steps need
  /// them, not stages.
  const std::vector<double>& numbers() {
    for (const Reversal& reversal : reversals_)
      for (std::size_t level = 0; level < std::size(kReversal); ++level)
        set(reversal.first + 2 * static_cast<int>(level), reversal.rate, -kReversal[level] * kFrictionSpeed,
            kReversal[level] * kFrictionSpeed);
    return numbers_;
  }

 private:
  /// Relative to the speed of smooth friction.
  static constexpr double kReversal[] = {0.7, 1.6, 3, 6};

  struct Reversal {
    int first;    // of its numbers
    double rate;  // [m/s or rad/s]
  };
  std::vector<double> numbers_;
  std::vector<Reversal> reversals_;
};

}  // namespace flexarm
