#pragma once
/// How much of a line slips over guides with friction in a step. (docs/notes/lines.md 4)

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "elements/slip_chain.h"
#include "elements/tendon_law.h"

namespace flexarm {

/// The lengths of one part of a line in a step, and the data of the rule for rates.
struct TendonPartStep {
  TendonLengths begin, end;
  double duration = 0;              ///< [s]; 0: an equilibrium
  bool at_end = false;              ///< forces are those at the end of the step; else means over it
  double rate = 0, rate_slope = 0;  ///< of length - rest length at the end, if `at_end`

  /// What the part does if its rest length at the end is larger by `slip`.
  TendonStep with(const TendonLaw& law, double slip) const;
  /// The same at the end of the step.
  TendonStep at_last(const TendonLaw& law, double slip) const;
  /// The rest length with which the tension of at_last() is `tension` [m]; with which the part is just slack, if 0.
  double rest_at(const TendonLaw& law, double tension) const;
};

/// The linearised condition of a guide, for small changes of the parts before ([0]) and behind it ([1]):
///   sum over both parts of by_length dL + by_rest dL0 = 0,
/// with the part's length L, and its rest length L0 with all slips. The derivative by the guide's own slip is 1.
struct SlipRow {
  bool slips = false;  ///< false: the guide's slip is zero instead
  double by_length[2] = {0, 0}, by_rest[2] = {0, 0};
};

/// Parts of a line, one after the other, with a guide between each two, over which the line may slip. Tensions at the
/// end of the step decide: with means, those at the ends would swing about them, and more so from step to step.
class TendonSlip {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// Begins a step: forgets the last slips. Makes room for all that solve() may need, also if nothing slips yet.
  void begin(int parts);
  /// The slips that the next solve() tries first. They may be set after begin(); else they are those of the last
  /// solve().
  Eigen::VectorXd& guess() { return slips_; }

  /// `parts`: of the line. `ratios`: per guide, the largest ratio of the tensions on both sides, >= 1, or kNever. Finds
  /// the slips with which no ratio is exceeded, and with which the line slips towards the larger tension only where the
  /// ratio is reached. Returns false if it does not find them.
  bool solve(const TendonLaw& law, const std::vector<TendonPartStep>& parts, const std::vector<double>& ratios);

  /// Gives all parts the same tension, whatever their lengths.
  void set_tension(int parts, double tension);

  /// Per part: what it does.
  const std::vector<TendonStep>& steps() const { return steps_; }
  /// Per part: what it does at the end of the step; the ratios are those of these tensions.
  const std::vector<TendonStep>& ends() const { return ends_; }
  /// Per guide: the length that has come from the part before it to the part behind it [m].
  const Eigen::VectorXd& slips() const { return slips_; }
  /// What the rest length of a part gains by slipping [m].
  double gain(int part) const { return (part > 0 ? slips_[part - 1] : 0) - (part < slips_.size() ? slips_[part] : 0); }
  /// The condition of a guide, for solve()'s last result.
  SlipRow row(int guide) const;
  /// Solves the conditions of all guides for the changes of their slips. `rows`: per guide, what its condition lacks if
  /// no slip changes, for any number of cases side by side; replaced by the change of the slip.
  void find_slopes(Eigen::Ref<Eigen::MatrixXd> rows);

 private:
  void evaluate();
  void evaluate(int part) { ends_[part] = (*parts_)[part].at_last(*law_, gain(part)); }
  double excess(int guide, int way) const;
  double excess_slope(int guide, int way) const;
  bool iterate();
  bool follow();
  bool find_slips();
  bool choose_ways();

  const TendonLaw* law_ = nullptr;                      // during solve()
  const std::vector<TendonPartStep>* parts_ = nullptr;  // during solve()
  double round_off_ = 0;                                // of tensions [N]
  std::vector<TendonStep> steps_, ends_;                // per part, over the step and at its end
  SlipChain chain_;
  std::vector<int> ways_;  // per guide: 1 and -1: it slips; 0: it sticks
  std::vector<double> ratios_;
  Eigen::VectorXd slips_, update_, pivots_;
};

}  // namespace flexarm
