#pragma once
/// A slender cantilever that is bent so slowly and so little that its tip follows the static solution.

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "accuracy/trial_runs.h"
#include "support/scene_text.h"

namespace flexarm::test {

/// The force grows as (1 - cos(pi t)) / 2 and moves the tip down by 1 cm within a second. The first mode has 56 Hz, so
/// inertia changes the displacement by the fraction (0.5 / 56)^2. `mesh`: attributes of <beam>.
inline scene::SceneDescription ramped_cantilever(const std::string& mesh) {
  const std::string text = fmt::format(R"scene(<robot name="ramp">
    <link name="world"/>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
    <link name="arm"> <beam {}>
      <centerline> <line to="1 0 0"/> </centerline>
      <section ea="1e9" ga2="1e9" ga3="1e9" gj="1e5" ei2="1e4" ei3="1e4" mass="1" j1="1e-4" j2="1e-4" j3="1e-4"/>
    </beam> </link>
    <simulation>
      <gravity xyz="0 0 0"/>
      <integrator step="0.01"/>
      <load link="arm" at="1 0 0" force="0 0 -300" history="0.5*(1-cos(3.141592653589793*t))"/>
      <probe name="tip" link="arm" at="1 0 0"/>
    </simulation>
  </robot>)scene",
                                       mesh);
  return scene_of(text);
}

constexpr JudgedTimes kOneSecond{0.02, 50};

/// Root mean square of the tip's displacement over the second, relative to its final value.
const double kRampRms = std::sqrt(3.0 / 8);

/// Relative error of the deflection with `n` elements of order 1 (one integration point, constant strains): that of the
/// midpoint rule for the integral of (1 - s)^2.
inline double linear_element_error(int n) {
  return 1 / (4.0 * n * n);
}

}  // namespace flexarm::test
