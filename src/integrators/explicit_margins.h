#pragma once
/// Numbers that vanish where efforts have kinks, for explicit schemes. (docs/notes/explicit.md 3)

#include <vector>

namespace flexarm {

/// How far quantities are from both of their bounds, at the instant that was evaluated last: the demand of a motor from
/// its limits, an effort of the scene from its limit, the twist of a gear from the ends of its play.
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
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  std::vector<double> numbers_;
};

}  // namespace flexarm
