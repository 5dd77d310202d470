#include "elements/slip_chain.h"

#include <algorithm>
#include <cmath>

#include "elements/tendon_slip.h"

namespace flexarm {

/// What a part gives away to have a tension [m]. It grows with the tension.
double SlipChain::lack(int part, double tension) const {
  return (*parts_)[part].end.rest - (*parts_)[part].rest_at(*law_, tension);
}

/// Derivative of the least sum of the parts up to `part` by the logarithm of its tension [m]. If the tension is not the
/// best one for the earlier parts, the guide before it is at its bound, on one side or the other.
double SlipChain::slope(int part, double tension) const {
  double sum = 0;
  for (int p = part;; --p) {
    sum += lack(p, tension);
    if (p == first_) return sum;
    const double ratio = (*ratios_)[p - 1], best = lowest_[p - 1];
    if (tension * ratio < best)
      tension *= ratio;
    else if (tension / ratio > best)
      tension /= ratio;
    else
      return sum;
  }
}

/// The tension of a part at which its slope() vanishes, by bisection; 0 if it is positive everywhere.
double SlipChain::lowest(int part) const {
  double low = 0, high = highest_;
  if (slope(part, low) >= 0) return 0;
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return high;
    (slope(part, middle) < 0 ? low : high) = middle;
  }
}

/// All parts are slack at the end of the step. Moves no more than what slack parts need.
void SlipChain::share_slack(Eigen::VectorXd& slips) const {
  double needs = 0;  // of the parts behind a guide
  for (int p = first_ + 1; p <= last_; ++p) needs -= lack(p, 0);
  double last = 0;
  for (int p = first_; p < last_; ++p) {
    slips[p] = std::clamp(0.0, needs, std::max(needs, last + lack(p, 0)));
    last = slips[p];
    needs += lack(p + 1, 0);
  }
}

void SlipChain::find(Eigen::VectorXd& slips) {
  highest_ = 0;
  for (int p = first_; p <= last_; ++p) highest_ = std::max(highest_, (*parts_)[p].at_last(*law_, 0).tension);
  for (int p = first_; p <= last_; ++p) lowest_[p] = lowest(p);
  if (lowest_[last_] == 0) return share_slack(slips);
  tension_[last_] = lowest_[last_];
  for (int p = last_ - 1; p >= first_; --p) {
    const double ratio = (*ratios_)[p];
    tension_[p] = std::clamp(lowest_[p], tension_[p + 1] / ratio, tension_[p + 1] * ratio);
  }
  double sum = 0;
  for (int p = first_; p < last_; ++p) {
    sum += lack(p, tension_[p]);
    if (tension_[p] == lowest_[p]) sum = 0;  // the guide sticks
    slips[p] = sum;
  }
}

void SlipChain::solve(const TendonLaw& law, const std::vector<TendonPartStep>& parts, const std::vector<double>& ratios,
                      Eigen::VectorXd& slips) {
  law_ = &law, parts_ = &parts, ratios_ = &ratios;
  lowest_.resize(parts.size()), tension_.resize(parts.size());
  slips.setZero();
  const int guides = static_cast<int>(ratios.size());
  first_ = 0;
  for (int i = 0; i <= guides; ++i) {
    if (i < guides && ratios[i] != TendonSlip::kNever) continue;
    last_ = i;
    if (last_ > first_) find(slips);
    first_ = i + 1;
  }
}

}  // namespace flexarm
