// Tests tendons as programs see them: sensors, and winches as inputs and outputs of linear models.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "flexarm/simulation/linear_model.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kHanging = 3, kReel = 0.7, kSpring = 500, kEa = 8000;  // kg, kg, N/m, N

/// A mass on a rope that a winch pays out, whose coordinate a spring holds, and a sensor of the rope.
std::string hoist(const std::string& sensor) {
  return robot(
      joint("rail", "prismatic", "world", "mass", "<origin xyz='0 0 -2'/><axis xyz='0 0 1'/>" + kFarLimits) +
          body("mass", kHanging) +
          fmt::format("<tendon name='rope' ea='{}'> <via link='world'/> <via link='mass'/> </tendon>"
                      "<winch name='reel' tendon='rope'> <spring stiffness='{}'/> <drive rotor_inertia='{}'/> </winch>"
                      "<sensor name='cell' kind='tendon' {}/>",
                      kEa, kSpring, kReel, sensor),
      "<integrator step='1e-3' tolerance='1e-12'/> <initial equilibrium='true'/>");
}

std::vector<double> rope_of(const Simulation& simulation) {
  return {column(simulation, "tendon/rope/length"), column(simulation, "tendon/rope/tension")};
}

}  // namespace

// With the energy EA (L - L0)^2 / (2 L0), the stiffness by (L, L0) is EA/L0 (1, -L/L0) (1, -L/L0)^T.
TEST(TendonPorts, AWinchIsAPortOfLinearModels) {
  const Simulation s(scene_of(hoist("tendon=\"rope\"")));
  const double weight = kHanging * 9.81, rest = kEa / (kEa + weight) * rope_of(s)[0], stretch = rope_of(s)[0] / rest;
  EXPECT_NEAR(rope_of(s)[1], weight, 1e-9 * weight);
  // What pays out is the spring's load: the energy falls by T + T^2 / (2 EA) per length of rope.
  EXPECT_NEAR(kSpring * s.position(*s.find_coordinate("reel")), weight + weight * weight / (2 * kEa), 1e-9 * weight);

  LinearRequest request;
  request.inputs = {"effort:reel"};
  request.outputs = {"position:rail", "position:reel"};
  const LinearModel model = linearise(s, request);
  Eigen::Matrix2d stiffness, mass = Eigen::Vector2d(kHanging, kReel).asDiagonal();
  stiffness << 1, stretch, stretch, stretch * stretch;  // the rail's coordinate goes up, against the length
  stiffness *= kEa / rest;
  stiffness(1, 1) += kSpring;
  const Eigen::Vector2d squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(stiffness, mass).eigenvalues();
  const std::vector<Pole> found = poles(model);
  ASSERT_EQ(found.size(), 2u);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(found[i].value.imag(), std::sqrt(squares[i]), 1e-9 * std::sqrt(squares[i]));
  // At rest the motion by the effort is that of the stiffness: x = -A^-1 B u.
  const Eigen::VectorXd still = -model.c * model.a.fullPivLu().solve(model.b);
  const Eigen::Vector2d expected = stiffness.inverse() * Eigen::Vector2d::UnitY();
  EXPECT_LE((still - expected).norm(), 1e-9 * expected.norm());
}

TEST(TendonPorts, ASensorMeasuresLengthAndTension) {
  Simulation s(scene_of(hoist(R"(tendon="rope" rate="100" bias="0.5 -7")")));
  s.command_effort(*s.find_coordinate("reel"), 20);
  for (int n = 1; n <= 95; ++n) {
    ASSERT_TRUE(s.step().converged);
    if (n != 90) continue;
    EXPECT_NEAR(s.sample(0).values[0], rope_of(s)[0] + 0.5, 1e-14);
    EXPECT_NEAR(s.sample(0).values[1], rope_of(s)[1] - 7, 1e-10);
  }
  EXPECT_NEAR(s.sample(0).time, 0.09, 1e-12);
  EXPECT_GT(std::abs(s.sample(0).values[1] + 7 - rope_of(s)[1]), 1e-3);  // it holds the sample
  EXPECT_EQ(column(s, "sensor/cell/tension"), s.sample(0).values[1]);
  EXPECT_EQ(s.scene().sensors[0].link, "world");  // of the first guide
}

TEST(TendonPorts, SensorsOfNoTendonAreRefused) {
  const auto expect_first = [](const std::string& sensor, const std::string& expected) {
    expect_contains(scene::read_scene_text(hoist(sensor), "hoist.urdf").diagnostics.at(0).text(), expected);
  };
  expect_first("tendon='rop'", "<sensor> 'cell': tendon must be the name of a <tendon> (rope), got 'rop'");
  expect_first("", "attribute 'tendon' is missing");
  expect_first("tendon='rope' at='0 0 1'", "a sensor of a tendon has no such attribute, got '0 0 1'");
  expect_first("tendon='rope' noise='1 2 3'", "noise must be 1 number or 2");
}

}  // namespace flexarm::test
