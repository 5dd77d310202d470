#include "limit_watch.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>

#include "flexarm/scene/scene_description.h"

namespace flexarm::node {
namespace {

/// Commands that follow each other within this time are one burst.
constexpr std::chrono::seconds kBurst(1);
/// So much of a joint's range is round-off.
constexpr double kRoundOff = 1e-4;

}  // namespace

void LimitWatch::look(std::size_t joint, double least, double most) {
  const std::string& name = shown_.coordinate_names()[joint];
  const scene::JointLimits* const limits = scene::limits_of(shown_.scene(), name);
  if (!limits) return;
  // A joint that is pressed on its stop is a little beyond the limit, and may set out from there.
  const double at = shown_.position(joint), range = limits->upper - limits->lower,
               round_off = std::isfinite(range) ? kRoundOff * range : 0;
  const bool is_above = most > std::max(limits->upper, at) + round_off;
  if (!is_above && least >= std::min(limits->lower, at) - round_off) return;
  const Clock::time_point now = Clock::now();
  const auto [last, is_first] = last_.emplace(name, now);
  const bool is_of_burst = !is_first && now - last->second < kBurst;
  last->second = now;
  if (is_of_burst) return;
  ROS_WARN("joint '%s' is sent to %g, beyond its %s limit %g, where its stop holds it", name.c_str(),
           is_above ? most : least, is_above ? "upper" : "lower", is_above ? limits->upper : limits->lower);
}

void LimitWatch::look(const JointTrajectory& trajectory) {
  for (std::size_t k = 0; k < trajectory.joints.size(); ++k) {
    const auto [least, most] =
        std::minmax_element(trajectory.points.begin(), trajectory.points.end(),
                            [k](const auto& a, const auto& b) { return a.positions[k] < b.positions[k]; });
    look(trajectory.joints[k], least->positions[k], most->positions[k]);
  }
}

}  // namespace flexarm::node
