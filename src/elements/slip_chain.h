#pragma once
/// Slips of a line over many guides with friction, without a start that is close. (docs/notes/lines.md 4)

#include <vector>

#include <Eigen/Core>

#include "elements/tendon_law.h"

namespace flexarm {

struct TendonPartStep;

/// Finds slips by minimisation: by the logarithms of the tensions, the balance of friction is the condition for the
/// minimum of a convex function of the parts' tensions, with bounds on the differences of neighbours. The minimum is
/// found part by part (dynamic programming), in n^2 evaluations.
class SlipChain {
 public:
  /// Makes room for so many parts: solve() allocates nothing then.
  void reserve(std::size_t parts) { lowest_.reserve(parts), tension_.reserve(parts); }
  /// `parts`, `ratios`: as of TendonSlip::solve(). `slips`: output, per guide.
  void solve(const TendonLaw& law, const std::vector<TendonPartStep>& parts, const std::vector<double>& ratios,
             Eigen::VectorXd& slips);

 private:
  double lack(int part, double tension) const;
  double slope(int part, double tension) const;
  double lowest(int part) const;
  void find(Eigen::VectorXd& slips);
  void share_slack(Eigen::VectorXd& slips) const;

  const TendonLaw* law_ = nullptr;  // these three during solve()
  const std::vector<TendonPartStep>* parts_ = nullptr;
  const std::vector<double>* ratios_ = nullptr;
  int first_ = 0, last_ = 0;     // parts between two guides on which nothing slips
  double highest_ = 0;           // tension of these parts without slip [N]
  std::vector<double> lowest_;   // per part: its tension at the minimum of the parts up to it [N]
  std::vector<double> tension_;  // per part
};

}  // namespace flexarm
