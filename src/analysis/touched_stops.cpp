#include "analysis/touched_stops.h"

#include <algorithm>
#include <cmath>

namespace flexarm {
namespace {

/// A coordinate touches a stop if it is no farther from it than this [rad, or in units of the length scale].
constexpr double kTouches = 1e-10;
/// A motion into a stop that is pressed goes at most this part of the remaining depth farther.
constexpr double kPartOfGive = 0.1;
/// Stops that give way by d change forces by about the reference curvature times d. This is a margin, and the largest
/// force that counts as weak, relative to the reference curvature.
constexpr double kMarginOfGive = 2, kMostOfWeak = 1e-3;

}  // namespace

TouchedStops::TouchedStops(const JointPotentials& potentials, const JointPotential& at)
    : potentials_(potentials), at_(at), touches_(potentials.axes().size()), is_open_(potentials.axes().size(), false) {
  double give = 0;
  for (const Bound& bound : potentials.bounds())
    give = std::max(give, depth(bound) * potentials.axes()[bound.axis].scale);
  weak_ = potentials.reference() * std::min(kMarginOfGive * give, kMostOfWeak);
  const Eigen::VectorXd force = at.force - at.stop_force;
  Eigen::MatrixXd free = at.curvature;
  free.diagonal() -= at.stop_curvature;
  std::vector<const Bound*> touched;
  for (const Bound& bound : potentials.bounds())
    if (touches(bound)) touched.push_back(&bound);
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(force.size(), static_cast<Eigen::Index>(touched.size()));
  for (std::size_t k = 0; k < touched.size(); ++k)
    motions(static_cast<Eigen::Index>(touched[k]->axis), static_cast<Eigen::Index>(k)) = 1;
  const Eigen::VectorXd round_off = potentials.round_off(at, free, motions);
  for (std::size_t k = 0; k < touched.size(); ++k) note(*touched[k], force, round_off[static_cast<Eigen::Index>(k)]);
}

/// `force`: without stops.
void TouchedStops::note(const Bound& bound, const Eigen::VectorXd& force, double round_off) {
  const double into = -bound.inward * force[static_cast<Eigen::Index>(bound.axis)];
  if (into < -round_off) return;  // the axis is pulled away
  Touch& touch = touches_[bound.axis];
  const bool is_deep = depth(bound) * potentials_.axes()[bound.axis].scale > kTouches;
  if (into <= round_off && !is_deep) {
    touch.is_grazed = true;
    return;
  }
  touch.pressed = bound.inward > 0 ? 1 : -1;
  touch.is_weak = into <= weak_;
}

double TouchedStops::depth(const Bound& bound) const {
  return bound.inward * (potentials_.position(at_.state, bound.axis) - bound.place);
}

bool TouchedStops::touches(const Bound& bound) const {
  return depth(bound) * potentials_.axes()[bound.axis].scale >= -kTouches;
}

std::vector<std::size_t> TouchedStops::grazing() const {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (touches_[i].is_grazed) axes.push_back(i);
  return axes;
}

std::vector<std::size_t> TouchedStops::free_to_leave() const {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (touches_[i].may_leave()) axes.push_back(i);
  return axes;
}

std::vector<bool> TouchedStops::shut() const {
  std::vector<bool> shut(touches_.size());
  for (std::size_t i = 0; i < touches_.size(); ++i) shut[i] = touches_[i].is_grazed && !is_open_[i];
  return shut;
}

void TouchedStops::open(const std::vector<std::size_t>& axes) {
  std::fill(is_open_.begin(), is_open_.end(), false);
  for (const std::size_t axis : axes) is_open_[axis] = true;
}

Eigen::VectorXd TouchedStops::force() const {
  Eigen::VectorXd force = at_.force;
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (pressed(i) == 0) force[static_cast<Eigen::Index>(i)] -= at_.stop_force[static_cast<Eigen::Index>(i)];
  for (const Bound& bound : potentials_.bounds()) {
    if (pressed(bound.axis) * bound.inward <= 0 || !touches(bound) || depth(bound) > 0) continue;
    force[static_cast<Eigen::Index>(bound.axis)] +=
        bound.inward * bound.stiffness * depth(bound) / potentials_.axes()[bound.axis].scale;
  }
  return force;
}

Eigen::MatrixXd TouchedStops::curvature() const {
  Eigen::MatrixXd curvature = at_.curvature;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (pressed(i) == 0) curvature(k, k) -= at_.stop_curvature[k];
  }
  for (const Bound& bound : potentials_.bounds()) {
    if (pressed(bound.axis) * bound.inward <= 0 || !touches(bound) || depth(bound) > 0) continue;
    const auto k = static_cast<Eigen::Index>(bound.axis);
    const double scale = potentials_.axes()[bound.axis].scale;
    curvature(k, k) += bound.stiffness / (scale * scale);
  }
  return curvature;
}

/// Whether a motion of the bound's axis [in its unit] ends at this bound.
bool TouchedStops::encounter(const Bound& bound, double way, Encounter& met) const {
  const double depth = this->depth(bound), deeper = bound.inward * way;
  const double scale = potentials_.axes()[bound.axis].scale;
  double end = 0;  // depth at the end
  if (pressed(bound.axis) * bound.inward > 0 && touches(bound)) {
    end = deeper > 0 ? std::max(depth, 0.0) + kPartOfGive * (bound.give - std::max(depth, 0.0)) : 0;
    if (deeper > 0 ? depth + deeper <= end : depth + deeper >= -kTouches / scale) return false;
    if (deeper < 0 && depth <= 0) end = depth;
  } else {
    if (deeper <= 0 || depth + deeper <= 0) return false;
    end = std::max(depth, 0.0);
  }
  met = {bound.axis, (end - depth) / deeper, scale * bound.inward * (end - depth)};
  return true;
}

bool TouchedStops::meets(const Eigen::VectorXd& ways, const std::vector<bool>& is_fixed, Encounter& first) const {
  bool is_met = false;
  Encounter met{};
  for (const Bound& bound : potentials_.bounds()) {
    const double way = ways[static_cast<Eigen::Index>(bound.axis)] / potentials_.axes()[bound.axis].scale;
    if (is_fixed[bound.axis] || way == 0 || !encounter(bound, way, met)) continue;
    if (!is_met || met.part < first.part) first = met;
    is_met = true;
  }
  return is_met;
}

}  // namespace flexarm
