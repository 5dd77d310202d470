#include "elements/tendon_slip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// With many guides the iteration may go round for ever; then SlipChain finds the slips.
constexpr int kMostIterations = 30;
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

void TendonSlip::begin(int parts) {
  slips_.setZero(parts - 1);
  update_.resize(parts - 1);
  chain_.reserve(static_cast<std::size_t>(parts));
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

/// The derivative of excess() by the guide's own slip. Zero or less for `way` 1, zero or more for -1.
double TendonSlip::excess_slope(int guide, int way) const {
  const double before = (way > 0 ? -ratios_[guide] : 1) * ends_[guide].by_rest;
  return (way > 0 ? 1 : -ratios_[guide]) * ends_[guide + 1].by_rest - before;
}

/// Chooses which guides slip next, and to which side: those on whose way the sum of the slip and of what would still
/// remove the excess is positive (a primal-dual active set: Hintermueller, Ito and Kunisch 2003). Returns whether all
/// guides stick or slip as they must.
bool TendonSlip::choose_ways() {
  bool is_solved = true;
  for (int i = 0; i < slips_.size(); ++i) {
    const int last = ways_[i];
    ways_[i] = 0;
    if (ratios_[i] == kNever) continue;
    double largest = 0;
    for (const int way : {1, -1}) {
      const double excess = this->excess(i, way), slope = excess_slope(i, way);
      if (slips_[i] == 0 && excess <= round_off_) continue;
      const double sum = way * slips_[i] + (slope == 0 ? 0 : excess / std::abs(slope));
      if (sum > largest) largest = sum, ways_[i] = way;
    }
    const bool turns = ways_[i] * last < 0,
               is_right = ways_[i] == 0 ? slips_[i] == 0
                                        : ways_[i] * slips_[i] > 0 && std::abs(excess(i, ways_[i])) <= round_off_;
    is_solved = is_solved && is_right && !turns;
    if (turns) ways_[i] = 0;  // it sticks before it turns round
  }
  return is_solved;
}

/// Newton's method for the guides that slip; the others go back to where they stick. Returns false if it does not
/// converge.
bool TendonSlip::iterate() {
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (choose_ways()) return true;
    update_ = -slips_;
    for (int i = 0; i < slips_.size(); ++i)
      if (ways_[i] != 0) update_[i] = row(i).slips ? -excess(i, ways_[i]) / excess_slope(i, ways_[i]) : 0;
    find_slopes(update_);
    if (!update_.allFinite()) return false;
    for (int i = 0; i < slips_.size(); ++i) slips_[i] = ways_[i] == 0 ? 0 : slips_[i] + update_[i];
    evaluate();
  }
  return choose_ways();
}

SlipRow TendonSlip::row(int guide) const {
  SlipRow out;
  const double slope = ways_[guide] == 0 ? 0 : excess_slope(guide, ways_[guide]);
  if (slope == 0) return out;
  out.slips = true;
  for (int k = 0; k < 2; ++k) {
    const double factor = ((k == 1) == (ways_[guide] > 0) ? 1 : -ratios_[guide]) / slope;
    out.by_length[k] = factor * ends_[guide + k].by_length;
    out.by_rest[k] = factor * ends_[guide + k].by_rest;
  }
  return out;
}

/// The system is tridiagonal. A part's rest length gains what slips over the guide before it, and loses what slips over
/// that behind it, so that each row's other entries add up to minus the diagonal. Pivots need no search then.
void TendonSlip::find_slopes(Eigen::Ref<Eigen::MatrixXd> rows) {
  const Eigen::Index count = rows.rows();
  pivots_.setOnes(count);
  for (Eigen::Index i = 1; i < count; ++i) {
    const SlipRow last = row(static_cast<int>(i - 1)), here = row(static_cast<int>(i));
    if (!here.slips) continue;
    const double factor = here.by_rest[0] / pivots_[i - 1];
    pivots_[i] += factor * last.by_rest[1];
    rows.row(i) -= factor * rows.row(i - 1);
  }
  for (Eigen::Index i = count; i-- > 0;) {
    if (i + 1 < count) rows.row(i) += row(static_cast<int>(i)).by_rest[1] * rows.row(i + 1);
    rows.row(i) /= pivots_[i];
  }
}

bool TendonSlip::solve(const TendonLaw& law, const std::vector<TendonPartStep>& parts,
                       const std::vector<double>& ratios) {
  law_ = &law;
  parts_ = &parts;
  ratios_ = ratios;
  steps_.resize(parts.size()), ends_.resize(parts.size());
  ways_.assign(ratios.size(), 0);
  if (slips_.size() != static_cast<Eigen::Index>(ratios.size())) begin(static_cast<int>(parts.size()));
  if (!find_slips()) return false;
  for (std::size_t p = 0; p < parts.size(); ++p) steps_[p] = parts[p].with(law, gain(static_cast<int>(p)));
  return true;
}

/// Whether the slips follow from those that are set. Between slack parts they are not unique, so that these must not
/// decide.
bool TendonSlip::follow() {
  evaluate();
  if (!iterate()) return false;
  for (int i = 0; i < slips_.size(); ++i)
    if (slips_[i] != 0 && !(ends_[i].tension > 0 || ends_[i + 1].tension > 0)) return false;
  return true;
}

bool TendonSlip::find_slips() {
  if (!slips_.isZero(0) && follow()) return true;
  slips_.setZero();
  evaluate();
  for (const TendonStep& step : ends_)
    if (!std::isfinite(step.tension)) return false;
  if (choose_ways() || follow()) return true;
  chain_.solve(*law_, *parts_, ratios_, slips_);
  evaluate();
  return choose_ways() || iterate();
}

void TendonSlip::set_tension(int parts, double tension) {
  TendonStep step;
  step.tension = tension;
  steps_.assign(parts, step);
  ends_ = steps_;
  ways_.assign(parts - 1, 0);
  slips_.setZero(parts - 1);
}

}  // namespace flexarm
