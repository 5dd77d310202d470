#include "elements/tendon_slip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

constexpr int kMostRounds = 2, kSweeps = 4, kMostIterations = 12, kMostHalvings = 200;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

TendonStep TendonPartStep::with(const TendonLaw& law, double slip) const {
  const TendonLengths last{end.length, end.rest + slip};
  if (!at_end) return law.means(begin, last, duration);
  const double change = last.length - last.rest - begin.length + begin.rest;
  return law.at_end(last, rate - rate_slope * slip, rate_slope, change);
}

TendonStep TendonPartStep::at_last(const TendonLaw& law, double slip) const {
  if (!(end.rest + slip > 0)) {  // nothing is left of the part
    TendonStep none;
    none.tension = std::numeric_limits<double>::infinity();
    return none;
  }
  if (at_end) return with(law, slip);
  const double slope = duration > 0 ? 1 / duration : 0, before = std::max(begin.length - begin.rest, 0.0);
  const TendonLengths last{end.length, end.rest + slip};
  const double change = last.length - last.rest - before;
  return law.at_end(last, slope * change, slope, change);
}

double TendonPartStep::rest_at(const TendonLaw& law, double tension) const {
  double slope = rate_slope, here = rate;
  if (!at_end) {
    slope = duration > 0 ? 1 / duration : 0;
    here = slope * (end.length - end.rest - std::max(begin.length - begin.rest, 0.0));
  }
  // EA (L/x - 1) + damping (here + slope (L0 - x)) = tension is quadratic in x.
  const double square = law.damping * slope, pull = law.stiffness * end.length;
  const double middle = tension + law.stiffness - law.damping * (here + slope * end.rest);
  const double root = std::sqrt(middle * middle + 4 * square * pull);
  const double rest = middle > 0 ? 2 * pull / (middle + root) : (root - middle) / (2 * square);
  return std::min(rest, end.length);
}

void TendonSlip::evaluate() {
  double largest = 0, rate = 0, length = 0;
  for (int p = 0; p < static_cast<int>(parts_->size()); ++p) {
    evaluate(p);
    const TendonPartStep& part = (*parts_)[p];
    if (std::isfinite(ends_[p].tension)) largest = std::max(largest, ends_[p].tension);
    length = std::max({length, part.end.length, part.end.rest});
    rate = part.at_end ? std::abs(part.rate_slope) : part.duration > 0 ? 1 / part.duration : 0;
  }
  // Ratios hold to a strain of 1e-12, or to round-off.
  round_off_ = 1e-12 * law_->stiffness + 64 * kEpsilon * (largest + law_->damping * rate * length);
}

/// The excess of a guide's tension towards `way` (1: behind it; -1: before it) over what its friction holds [N].
double TendonSlip::excess(int guide, int way) const {
  const double pulls = ends_[way > 0 ? guide + 1 : guide].tension, holds = ends_[way > 0 ? guide : guide + 1].tension;
  return pulls - ratios_[guide] * holds;
}

/// Finds the slip of one guide while the others are what they are: the excess falls where the line slips towards it, so
/// its root lies between no slip and a slip that is large enough.
void TendonSlip::settle(int guide) {
  if (ratios_[guide] == kNever) return;
  const auto slip = [&](double way) {
    slips_[guide] = way;
    evaluate(guide), evaluate(guide + 1);
  };
  slip(0);
  const int way = excess(guide, 1) > round_off_ ? 1 : excess(guide, -1) > round_off_ ? -1 : 0;
  if (way == 0) return;
  double least = 0, most = kEpsilon * (*parts_)[guide].end.rest;
  for (slip(way * most); excess(guide, way) > 0 && std::isfinite(most); slip(way * most)) least = most, most *= 8;
  double middle = 0.5 * (least + most);
  for (int k = 0; k < kMostHalvings && least < middle && middle < most; ++k) {
    slip(way * middle);
    const double here = excess(guide, way);
    if (std::abs(here) <= round_off_) return;
    (here > 0 ? least : most) = middle;
    const int pull = way > 0 ? guide + 1 : guide, hold = way > 0 ? guide : guide + 1;
    const double slope = ends_[pull].by_rest + ratios_[guide] * ends_[hold].by_rest;
    middle -= here / slope;  // Newton's method, if it stays between both
    if (!(least < middle && middle < most)) middle = 0.5 * (least + most);
  }
}

/// Whether all guides stick or slip as they must. Chooses the ways of those that slip.
bool TendonSlip::is_solved() {
  bool is_solved = true;
  for (int i = 0; i < slips_.size(); ++i) {
    ways_[i] = slips_[i] > 0 ? 1 : slips_[i] < 0 ? -1 : 0;
    if (ratios_[i] == kNever) continue;
    for (const int way : {1, -1}) {
      if (ways_[i] == 0 && excess(i, way) > round_off_) ways_[i] = way, is_solved = false;
      if (ways_[i] == way && std::abs(excess(i, way)) > round_off_) is_solved = false;
    }
  }
  return is_solved;
}

/// Newton's method for the guides that slip now. Returns false if others would have to, or some of them not.
bool TendonSlip::iterate() {
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (is_solved()) return true;
    right_.setZero(slips_.size());
    for (int i = 0; i < slips_.size(); ++i)
      if (ways_[i] != 0) right_[i] = -excess(i, ways_[i]);
    assemble();
    factors_.compute(slopes_);
    update_ = factors_.solve(right_);
    if (!update_.allFinite()) return false;
    for (int i = 0; i < slips_.size(); ++i) {
      if (ways_[i] != 0) slips_[i] += update_[i];  // round-off must not move those that stick
      if (ways_[i] * slips_[i] < 0) return false;
    }
    evaluate();
  }
  return false;
}

/// Derivatives of the excesses by the slips; for guides that stick, those of the slips themselves.
void TendonSlip::assemble() {
  const Eigen::Index count = slips_.size();
  slopes_.setIdentity(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (ways_[i] == 0) continue;
    slopes_(i, i) = 0;
    for (const Eigen::Index part : {i, i + 1}) {
      const bool pulls = (part == i + 1) == (ways_[i] > 0);
      const double factor = (pulls ? 1 : -ratios_[i]) * ends_[part].by_rest;
      if (part > 0) slopes_(i, part - 1) += factor;
      if (part < count) slopes_(i, part) -= factor;
    }
  }
}

bool TendonSlip::solve(const TendonLaw& law, const std::vector<TendonPartStep>& parts,
                       const std::vector<double>& ratios) {
  law_ = &law;
  parts_ = &parts;
  ratios_ = ratios;
  steps_.resize(parts.size()), ends_.resize(parts.size());
  ways_.assign(ratios.size(), 0);
  slips_.setZero(static_cast<Eigen::Index>(ratios.size()));
  if (!find_slips()) return false;
  for (std::size_t p = 0; p < parts.size(); ++p) steps_[p] = parts[p].with(law, gain(static_cast<int>(p)));
  return true;
}

bool TendonSlip::find_slips() {
  evaluate();
  for (const TendonStep& step : ends_)
    if (!std::isfinite(step.tension)) return false;
  if (is_solved()) return true;
  for (int round = 0; round < kMostRounds; ++round) {
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int i = 0; i < slips_.size(); ++i) settle(i);
    evaluate();
    settled_ = slips_;
    if (iterate()) return true;
    slips_ = settled_;
    evaluate();
  }
  chain_.solve(*law_, *parts_, ratios_, slips_);
  evaluate();
  return is_solved() || iterate();
}

void TendonSlip::set_tension(int parts, double tension) {
  TendonStep step;
  step.tension = tension;
  steps_.assign(parts, step);
  ends_ = steps_;
  ways_.assign(parts - 1, 0);
  slips_.setZero(parts - 1);
}

void TendonSlip::find_slopes() {
  const Eigen::Index count = slips_.size(), parts = static_cast<Eigen::Index>(steps_.size());
  by_length_.setZero(count, parts);
  by_rest_.setZero(count, parts);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (ways_[i] == 0) continue;
    for (const Eigen::Index part : {i, i + 1}) {
      const bool pulls = (part == i + 1) == (ways_[i] > 0);
      const double factor = pulls ? -1 : ratios_[i];
      by_length_(i, part) = factor * ends_[part].by_length;
      by_rest_(i, part) = factor * ends_[part].by_rest;
    }
  }
  if (std::count(ways_.begin(), ways_.end(), 0) == count) return;
  assemble();
  factors_.compute(slopes_);
  solution_ = factors_.solve(by_length_);
  by_length_.swap(solution_);
  solution_ = factors_.solve(by_rest_);
  by_rest_.swap(solution_);
}

}  // namespace flexarm
