// Tests simulations of lines over many links: closed forms in statics, conservation of energy, and friction.
#include <cmath>
#include <string>

#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kStiffness = 4e4, kMass = 5, kWeight = 5 * 9.81;  // EA [N], of the load [kg], [N]

/// A boom of 2 m on a hinge, with a load at its tip. A line runs up over five wheels on the axis above the hinge, and
/// down to the tip. Springs hold the wheels, on whose axes the line acts.
Simulation crane() {
  std::string parts, guides;
  for (int i = 0; i < 5; ++i) {
    const std::string axle = fmt::format("axle{}", i), wheel = fmt::format("wheel{}", i);
    parts += joint(axle, "continuous", "world", wheel,
                   fmt::format("<origin xyz='0 0 {}'/><axis xyz='0 1 0'/>", 1 + 0.25 * i)) +
             "<spring joint='" + axle + "' stiffness='1'/>" + body(wheel, 0.1, Vector3::Constant(0.01));
    guides += fmt::format("<via link=\"wheel{}\"/>", i);
  }
  return simulation_of_parts(
      joint("hinge", "continuous", "world", "boom", "<axis xyz='0 1 0'/>") +
          body("boom", kMass, Vector3::Constant(0.1), {2, 0, 0}) + parts +
          fmt::format("<tendon name='line' ea='{}'> {} <via link='boom' at='2 0 0'/> </tendon>", kStiffness, guides),
      gravity({0, 0, -9.81}));
}

/// The length of the line, and its derivative, with the boom turned downwards by an angle.
double line_length(double angle) {
  return 1 + std::hypot(2 * std::cos(angle), 2 + 2 * std::sin(angle));
}
double line_slope(double angle) {
  return 4 * std::cos(angle) / (line_length(angle) - 1);
}

// Only the line holds the boom: its moment is that of the weight.
TEST(LongLines, HoldABoomInStatics) {
  Simulation s = crane();
  ASSERT_TRUE(s.solve_static(1).converged);
  const double rest = line_length(0);
  double low = 0, high = 0.1;
  while (high - low > 1e-15) {
    const double angle = 0.5 * (low + high), tension = kStiffness * (line_length(angle) / rest - 1);
    (tension * line_slope(angle) < 2 * kWeight * std::cos(angle) ? low : high) = angle;
    if (0.5 * (low + high) == low || 0.5 * (low + high) == high) break;
  }
  EXPECT_NEAR(column(s, "joint/hinge/position"), low, 1e-11);
  EXPECT_NEAR(column(s, "tendon/line/tension"), kStiffness * (line_length(low) / rest - 1), 1e-6);
}

// The load falls into the line, so that the boom swings up again.
TEST(LongLines, ConserveEnergy) {
  Simulation s = crane();
  const double start = s.energies().total();
  double most = 0;
  run(s, 400, [&] {
    EXPECT_NEAR(s.energies().total(), start, 1e-10);  // energies of 1 J
    most = std::max(most, column(s, "tendon/line/tension"));
  });
  EXPECT_GT(most, 1.5 * kWeight);
}

/// A rope over nine posts at the corners of a regular polygon, where it turns by 30 degrees each. Both ends lead on
/// straight to trolleys on rails: one is held by an effort, the other one moves steadily.
Simulation posts(double friction) {
  constexpr int kPosts = 9;
  constexpr double kTurn = M_PI / 6;
  std::string parts, guides;
  double x = 0, z = 0, direction = 0;
  for (int i = 0; i < kPosts; ++i) {
    const std::string rail = fmt::format("rail{}", i), post = fmt::format("post{}", i);
    parts += joint(rail, "prismatic", "world", post,
                   "<origin xyz='" + xyz({x, 0, z}) + "'/><axis xyz='0 1 0'/>" + kFarLimits) +
             "<spring joint='" + rail + "' stiffness='100'/>" + body(post, 1, Vector3::Constant(0.01));
    guides += fmt::format("<via link=\"post{}\" friction=\"{}\"/>", i, friction);
    direction += kTurn;
    x += std::cos(direction), z += std::sin(direction);
  }
  return Simulation(scene_of(robot(
      parts +
          joint("pull", "prismatic", "world", "trolley",
                "<origin xyz='" + xyz({x, 0, z}) + "'/><axis xyz='" +
                    xyz({std::cos(direction), 0, std::sin(direction)}) + "'/>" + kFarLimits) +
          body("trolley", 1, Vector3::Constant(0.01)) +
          joint("hold", "prismatic", "world", "weight", "<origin xyz='-1 0 0'/><axis xyz='-1 0 0'/>" + kFarLimits) +
          body("weight", 1, Vector3::Constant(0.01)) +
          "<tendon name='rope' ea='1e4' damping='200'> <via link='weight'/>" + guides +
          "<via link='trolley'/> </tendon>",
      integrator("em", 1e-2, 1e-12) + "<effort joint='hold' history='20'/>"
                                      "<motion joint='pull' position='0.025*exp(-4*t)+0.1*t-0.025'/>")));
}

// Euler and Eytelwein: the tensions at both ends have the ratio exp(friction * angle), over nine posts that are nine
// links. What the pull does more than the effort takes is dissipated. The weight moves almost as steadily as the
// trolley, so that the tension behind it is the effort.
TEST(LongLines, SlipOverManyPosts) {
  constexpr double kFriction = 0.15;
  Simulation s = posts(kFriction);
  const double start = energy_account(s);
  run(s, 500, [&] { EXPECT_NEAR(energy_account(s), start, 1e-9); });  // works of up to 40 J
  const double ratio = std::exp(kFriction * 9 * M_PI / 6);
  EXPECT_NEAR(column(s, "tendon/rope/tension"), 20, 20 * 1e-6);
  EXPECT_NEAR(column(s, "tendon/rope/last_tension"), 20 * ratio, 20 * ratio * 1e-6);
  const double slipped = 20 * (ratio - 1) * 0.475;
  EXPECT_NEAR(s.energies().dissipated, slipped, 0.01 * slipped);  // but for the start
}

}  // namespace
}  // namespace flexarm::test
