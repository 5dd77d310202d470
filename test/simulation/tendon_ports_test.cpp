// Tests tendons as programs see them: sensors, and winches as inputs and outputs of linear models.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/linear_model.h"
#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test {
namespace {

constexpr double kHanging = 3, kReel = 0.7, kSpring = 500, kEa = 8000;  // kg, kg, N/m, N

/// A mass on a rope that a winch pays out, whose coordinate a spring holds, and a sensor of the rope.
scene::ReadResult hoist(const std::string& sensor) {
  return scene::read_scene_text(fmt::format(R"(<robot name="hoist"> <link name="world"/>
        <joint name="rail" type="prismatic"> <parent link="world"/> <child link="mass"/> <origin xyz="0 0 -2"/>
          <axis xyz="0 0 1"/> <limit lower="-9" upper="1" effort="0" velocity="0"/> </joint>
        <link name="mass"> <inertial> <mass value="{}"/>
          <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
        <tendon name="rope" ea="{}"> <via link="world"/> <via link="mass"/> </tendon>
        <winch name="reel" tendon="rope"> <spring stiffness="{}"/> <drive rotor_inertia="{}"/> </winch>
        <sensor name="cell" kind="tendon" {}/>
        <simulation> <integrator step="1e-3" tolerance="1e-12"/> <initial equilibrium="true"/> </simulation> </robot>)",
                                            kHanging, kEa, kSpring, kReel, sensor),
                                "hoist.urdf");
}

Simulation hoist_with(const std::string& sensor) {
  const scene::ReadResult read = hoist(sensor);
  for (const scene::Diagnostic& finding : read.diagnostics) ADD_FAILURE() << finding.text();
  return Simulation(read.scene.value());
}

std::vector<double> rope_of(const Simulation& simulation) {
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"tendon/rope/length", "tendon/rope/tension"});
  std::vector<double> row = columns.row(simulation, {});
  return {row[row.size() - 2], row[row.size() - 1]};
}

}  // namespace

// With the energy EA (L - L0)^2 / (2 L0), the stiffness by (L, L0) is EA/L0 (1, -L/L0) (1, -L/L0)^T.
TEST(TendonPorts, AWinchIsAPortOfLinearModels) {
  const Simulation s = hoist_with("tendon=\"rope\"");
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
  Simulation s = hoist_with(R"(tendon="rope" rate="100" bias="0.5 -7")");
  s.command_effort(*s.find_coordinate("reel"), 20);
  for (int n = 1; n <= 95; ++n) {
    ASSERT_TRUE(s.step().converged);
    if (n != 90) continue;
    EXPECT_NEAR(s.sample(0).values[0], rope_of(s)[0] + 0.5, 1e-14);
    EXPECT_NEAR(s.sample(0).values[1], rope_of(s)[1] - 7, 1e-10);
  }
  EXPECT_NEAR(s.sample(0).time, 0.09, 1e-12);
  EXPECT_GT(std::abs(s.sample(0).values[1] + 7 - rope_of(s)[1]), 1e-3);  // it holds the sample
  ResultColumns columns(s, ResultColumns::Solver::Without, {"sensor/cell/length", "sensor/cell/tension"});
  const std::vector<double> row = columns.row(s, {});
  EXPECT_EQ(row[row.size() - 1], s.sample(0).values[1]);
  EXPECT_EQ(s.scene().sensors[0].link, "world");  // of the first guide
}

TEST(TendonPorts, SensorsOfNoTendonAreRefused) {
  const auto first = [](const std::string& sensor) { return hoist(sensor).diagnostics.at(0).text(); };
  EXPECT_NE(first(R"(tendon="rop")").find("<sensor> 'cell': tendon must be the name of a <tendon> (rope), got 'rop'"),
            std::string::npos);
  EXPECT_NE(first("").find("attribute 'tendon' is missing"), std::string::npos);
  EXPECT_NE(first(R"(tendon="rope" at="0 0 1")").find("a sensor of a tendon has no such attribute, got '0 0 1'"),
            std::string::npos);
  EXPECT_NE(first(R"(tendon="rope" noise="1 2 3")").find("noise must be 1 number or 2"), std::string::npos);
}

}  // namespace flexarm::test
