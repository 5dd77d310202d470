// Tests what sensors measure, at which times, and with which errors.

#include <filesystem>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::SensorKind;

constexpr double kLength = 1.2, kStiffness = 300;  // m, N m^2

/// A cantilever along x. Loads at its tip are small, so that linear theory holds.
SceneBuilder cantilever() {
  SceneBuilder b;
  b.beam("arm", {{kLength, 0, 0}}, section(1e6, 1e5, 200, kStiffness, 0.5, 0.02, 0.01), 3, 2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  return b;
}

// A force P at the tip gives M(s) = P (L - s). The fibre at y, z has the strain -y K_z + z K_y + N/EA. The axial force
// adds a moment by the deflection of 6e-7 m, 3e-6 of the moments.
TEST(Sensors, MeasureTheStrainOfALoadedCantilever) {
  const double p = 3e-4, q = 2e-4, axial = 1e-3;
  SceneBuilder b = cantilever();
  b.load("arm", {kLength, 0, 0}, {0, p, 0});
  b.load("arm", {kLength, 0, 0}, {axial, 0, q});
  const double s = 0.31, y = 0.02, z = -0.03;
  b.sensor("gauge", SensorKind::Strain, "arm", {s, y, z});
  b.sensor("section", SensorKind::SectionForce, "arm", {s, 0, 0});
  b.scene.integrator.tolerance = 1e-12;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const double about_z = p * (kLength - s), about_y = -q * (kLength - s);
  const double strain = axial / 1e6 + (-y * about_z + z * about_y) / kStiffness;
  EXPECT_NEAR(simulation.sample(0).values[0], strain, 1e-5 * std::abs(strain));
  const SensorSample& section = simulation.sample(1);
  EXPECT_NEAR(section.values[0], axial, 1e-5 * axial);
  EXPECT_NEAR(section.values[1], p, 1e-5 * p);
  EXPECT_NEAR(section.values[4], about_y, 1e-5 * std::abs(about_y));
  EXPECT_NEAR(section.values[5], about_z, 1e-5 * std::abs(about_z));
}

TEST(Sensors, MeasureAtTheirPlaceBesideTheMassCentroid) {
  // The reference line is 0.05 m beside the mass centroid. The section bends about the centroid.
  SceneBuilder b;
  scene::MatrixSection matrices;
  const double ea = 1e4, m = 0.5, c = 0.05;
  matrices.stiffness = (Vector6() << ea, 5e3, 5e3, 200, kStiffness, kStiffness).finished().asDiagonal();
  matrices.inertia = (Vector6() << m, m, m, 0.02, 0.01, 0.01).finished().asDiagonal();
  const Matrix3 d = (Matrix3() << 0, 0, c, 0, 0, 0, -c, 0, 0).finished();
  matrices.inertia.topRightCorner<3, 3>() = -m * d;
  matrices.inertia.bottomLeftCorner<3, 3>() = m * d;
  matrices.inertia.bottomRightCorner<3, 3>() -= m * d * d;
  b.beam("arm", {{kLength, 0, 0}}, matrices, 3, 2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {kLength, 0, 0}, Vector3::Zero(), {0, 0, 3e-3});
  b.sensor("gauge", SensorKind::Strain, "arm", {0.4, 0.02, 0});
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const double expected = -0.02 * 3e-3 / kStiffness;
  EXPECT_NEAR(simulation.sample(0).values[0], expected, 1e-6 * std::abs(expected));
}

/// A flexible arm with a body at its end. A prescribed motion spins it up. One inertial unit is in the span, one in the
/// body.
SceneBuilder spinning_arm(double step) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  // Rotary inertia is so large, and the arm so soft, that steps resolve the fastest modes.
  b.beam("arm", {{0.8, 0, 0}}, scene::DirectSection{2e3, 1e3, 1e3, 80, 100, 120, 4, 4, 4, 4}, 2, 2);
  b.joint("hinge", scene::JointKind::Revolute, "world", "arm", {0, 0, 0.5}, {0, 0, 1});
  b.body("hand", 0.7, {0.05, 0.02, 0}, Vector3(0.1, 0.2, 0.15).asDiagonal());
  b.joint("wrist", scene::JointKind::Revolute, "arm", "hand", {0.8, 0, 0}, {0, 1, 0});
  b.scene.motions.push_back({"hinge", TimeFunction::parse("2*t+0.3*sin(3*t)"), {}});
  for (const auto& [name, link, at] :
       {std::tuple("span", "arm", Vector3(0.5, 0.02, 0.01)), std::tuple("palm", "hand", Vector3(0.1, 0, 0.02))}) {
    b.sensor(name, SensorKind::Imu, link, at);
    b.probe(name, link, at);
  }
  b.scene.integrator.step = step;
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

/// Largest differences between the inertial units and the kinematics of probes at the same points, for t = 0.2 ... 0.8
/// s. The kinematics come from central differences of second order.
std::array<double, 2> errors_against_kinematics(double step) {
  Simulation simulation(spinning_arm(step).scene);
  std::vector<std::array<Pose, 2>> poses;
  std::vector<std::array<SensorSample, 2>> samples;
  for (int n = 0; n * step < 0.8; ++n) {
    EXPECT_TRUE(simulation.step().converged);
    poses.push_back({simulation.probe(0).pose, simulation.probe(1).pose});
    samples.push_back({simulation.sample(0), simulation.sample(1)});
  }
  std::array<double, 2> worst = {0, 0};
  for (std::size_t n = static_cast<std::size_t>(0.2 / step); n + 1 < poses.size(); ++n)
    for (int i = 0; i < 2; ++i) {
      const Pose &before = poses[n - 1][i], &now = poses[n][i], &after = poses[n + 1][i];
      const Vector3 acceleration = (after.position - 2 * now.position + before.position) / (step * step);
      const Vector3 proper = now.orientation.conjugate() * (acceleration + Vector3(0, 0, 9.81));
      const Eigen::AngleAxisd turn(before.orientation.conjugate() * after.orientation);
      const Vector3 spin = turn.angle() / (2 * step) * turn.axis();
      const std::array<double, SensorSample::kMostValues>& values = samples[n][i].values;
      worst[0] = std::max(worst[0], (Vector3(values[0], values[1], values[2]) - spin).norm());
      worst[1] = std::max(worst[1], (Vector3(values[3], values[4], values[5]) - proper).norm());
    }
  return worst;
}

TEST(Sensors, OfInertiaAgreeWithTheKinematicsOfASpinningArm) {
  const std::array<double, 2> coarse = errors_against_kinematics(2e-3), fine = errors_against_kinematics(1e-3);
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(std::log2(coarse[i] / fine[i]), 1.7) << coarse[i] << " " << fine[i];
    EXPECT_LT(std::log2(coarse[i] / fine[i]), 3.5) << coarse[i] << " " << fine[i];
  }
  EXPECT_LT(fine[0], 1e-2);
  EXPECT_LT(fine[1], 0.2);
}

TEST(Sensors, OfInertiaMeasureGravityAtRest) {
  SceneBuilder b = cantilever();
  b.scene.gravity = {0, 0, -9.81};
  b.sensor("imu", SensorKind::Imu, "arm", {kLength, 0, 0});
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
  const auto& values = simulation.sample(0).values;
  EXPECT_NEAR(Vector3(values[3], values[4], values[5]).norm(), 9.81, 1e-6);
  EXPECT_GT(values[5], 9.7);
}

// Differences over steps of a motion on a circle are off by less than the square of the angle of two steps.
TEST(Sensors, OfTwistsMeasureVelocitiesInTheWorld) {
  const double omega = 2, step = 1e-3;
  SceneBuilder b;
  b.body("arm", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("hinge", scene::JointKind::Continuous, "world", "arm", {0, 0, 0.5}, {0, 0, 1});
  b.scene.motions.push_back({"hinge", TimeFunction::parse("2*t"), {}});
  b.scene.integrator.step = step;
  b.sensor("odometer", SensorKind::Twist, "arm", {0.3, 0.4, 0.1});
  Simulation simulation(b.scene);
  for (int n = 0; n < 50; ++n) ASSERT_TRUE(simulation.step().converged);
  const Vector3 spin(0, 0, omega),
      at = Eigen::AngleAxisd(omega * simulation.time(), spin / omega) * Vector3(0.3, 0.4, 0);
  const auto& values = simulation.sample(0).values;
  const double bound = omega * std::pow(2 * omega * step, 2);
  EXPECT_LT((Vector3(values[0], values[1], values[2]) - spin.cross(at)).norm(), bound * at.norm());
  EXPECT_LT((Vector3(values[3], values[4], values[5]) - spin).norm(), bound);
}

/// A body that moves along a rail at 0.5 m/s, with a sensor on it.
SceneBuilder moving_body(const scene::Sensor& sensor) {
  SceneBuilder b;
  b.body("cart", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "cart", Vector3::Zero(), {1, 0, 0});
  b.scene.initial_joints.push_back({"rail", 0, 0.5, {}});
  b.scene.integrator.step = 1e-3;
  b.scene.sensors.push_back(sensor);
  return b;
}

scene::Sensor pose_sensor(const std::string& name = "eye") {
  scene::Sensor sensor;
  sensor.name = name;
  sensor.link = "cart";
  return sensor;
}

TEST(Sensors, HoldASampleUntilTheNextOne) {
  scene::Sensor sensor = pose_sensor();
  sensor.rate = 150;  // every 6.67 steps
  Simulation simulation(moving_body(sensor).scene);
  EXPECT_EQ(simulation.sample(0).time, 0);
  int samples = 1;
  for (int n = 1; n <= 1000; ++n) {
    const double before = simulation.sample(0).time;
    ASSERT_TRUE(simulation.step().converged);
    const SensorSample& sample = simulation.sample(0);
    samples += sample.time != before;
    EXPECT_NEAR(sample.values[0], 0.5 * sample.time, 1e-9);
    EXPECT_LT(simulation.time() - sample.time, 1.0 / 150 - 1e-6);
  }
  EXPECT_EQ(samples, 151);
}

TEST(Sensors, HaveBiasAndNormalNoise) {
  scene::Sensor sensor = pose_sensor();
  sensor.noise = {0.1, 0.2, 0.3, 0, 0, 0};
  sensor.bias = {1, 0, -1, 0, 0, 0.5};
  Simulation simulation(moving_body(sensor).scene);
  constexpr int kSamples = 20000;
  Vector3 sum = Vector3::Zero(), squares = Vector3::Zero();
  double product = 0, last = 0, within = 0;
  for (int n = 0; n < kSamples; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const auto& values = simulation.sample(0).values;
    const Vector3 error = Vector3(values[0] - 0.5 * simulation.time() - 1, values[1], values[2] + 1);
    sum += error;
    squares += error.cwiseAbs2();
    product += error[0] * last;
    last = error[0];
    within += std::abs(error[1]) < 0.2;
    EXPECT_NEAR(2 * std::acos(std::abs(values[6])), 0.5, 1e-7);
  }
  // Each mean is within four standard deviations of its expected value for this number of samples.
  const double root = std::sqrt(kSamples);
  for (int k = 0; k < 3; ++k) {
    const double deviation = sensor.noise[k];
    EXPECT_LT(std::abs(sum[k]) / kSamples, 4 * deviation / root);
    EXPECT_NEAR(squares[k] / kSamples, deviation * deviation, 4 * std::sqrt(2.0) * deviation * deviation / root);
  }
  EXPECT_LT(std::abs(product) / kSamples, 4 * 0.01 / root) << "samples are independent";
  EXPECT_NEAR(within / kSamples, 0.6827, 4 * std::sqrt(0.6827 * 0.3173) / root) << "they are normal";
}

std::vector<double> noise_of(const scene::Sensor& sensor) {
  Simulation simulation(moving_body(sensor).scene);
  std::vector<double> noise;
  for (int n = 0; n < 5; ++n) {
    simulation.step();
    noise.push_back(simulation.sample(0).values[1]);
  }
  return noise;
}

TEST(Sensors, HaveNoiseOfTheirSeedAndName) {
  scene::Sensor sensor = pose_sensor();
  sensor.noise = {0.1};
  const std::vector<double> noise = noise_of(sensor);
  EXPECT_EQ(noise, noise_of(sensor));
  sensor.seed = 1;
  EXPECT_NE(noise, noise_of(sensor));
  scene::Sensor other = pose_sensor("other");
  other.noise = {0.1};
  EXPECT_NE(noise, noise_of(other));
}

// Reactions and the last samples are part of the state.
TEST(Sensors, GoOnFromACheckpointAsIfNothingHadBeen) {
  SceneBuilder b = spinning_arm(2e-3);
  b.sensor("root", SensorKind::Reaction, "arm");
  b.sensor("gauge", SensorKind::Strain, "arm", {0.3, 0.02, 0});
  for (scene::Sensor& sensor : b.scene.sensors) sensor.noise = {0.01}, sensor.rate = 170;
  const SimulationOptions options = full_newton();
  Simulation whole(b.scene, options), resumed(b.scene, options);
  for (int n = 0; n < 50; ++n) whole.step();
  const std::string path = (std::filesystem::temp_directory_path() / "flexarm_sensors_test").string();
  write_checkpoint(whole, path);
  read_checkpoint(resumed, path);
  std::filesystem::remove(path);
  for (int n = 0; n < 20; ++n) {
    for (std::size_t i = 0; i < b.scene.sensors.size(); ++i) {
      EXPECT_EQ(whole.sample(i).time, resumed.sample(i).time);
      EXPECT_EQ(whole.sample(i).values, resumed.sample(i).values);
    }
    whole.step(), resumed.step();
  }
}

TEST(Sensors, AreWhatTheyWereAfterAReset) {
  SceneBuilder b = spinning_arm(2e-3);
  Simulation simulation(b.scene);
  const auto before = simulation.sample(0).values;
  for (int n = 0; n < 5; ++n) simulation.step();
  EXPECT_NE(simulation.sample(0).values, before);
  simulation.reset();
  EXPECT_EQ(simulation.sample(0).values, before);
  EXPECT_EQ(simulation.sample(0).time, 0);
}

TEST(Sensors, ChangeNothing) {
  SceneBuilder b = spinning_arm(2e-3);
  Simulation with(b.scene);
  b.scene.sensors.clear();
  Simulation without(b.scene);
  for (int n = 0; n < 20; ++n) with.step(), without.step();
  EXPECT_EQ(with.position(0), without.position(0));
  EXPECT_EQ(with.probe(1).pose.position, without.probe(1).pose.position);
}

TEST(Sections, AreWhereTheyAreAskedFor) {
  Simulation simulation(cantilever().scene);
  std::vector<BeamPoint> points;
  simulation.beam_points(1, 1, points);
  for (const BeamPoint& point : points) {
    const BeamPoint section = simulation.section(1, point.arc_length);
    EXPECT_NEAR(section.arc_length, point.arc_length, 1e-15);
    EXPECT_LE((section.pose.position - point.pose.position).norm(), 1e-14);
  }
  EXPECT_THROW(simulation.section(1, kLength + 0.1), std::invalid_argument);
  EXPECT_THROW(simulation.section(0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flexarm::test
