// Tests published velocities and efforts: they are of second order at their time stamp, and do not oscillate.
#include <cstdio>
#include <vector>

#include "reference/documented_arms.h"
#include "reference/dynamics_joint_chain.h"
#include "reference/ode.h"
#include "schemes/scheme.h"

namespace flexarm::test {
namespace {

constexpr double kCoarsestStep = 0.02, kUntil = 1, kJumpsAt = 0.5;

/// An arm with so much rotary inertia that the steps resolve its fastest modes.
SceneBuilder arm() {
  const scene::DirectSection slow{2e3, 1e3, 1e3, 80, 100, 120, 4, 4, 4, 4};
  SceneBuilder b = flexible_arm(slow, 1);
  initial_joint(b, "elbow/rx", 0.2, -1);
  b.probe("hand", "gripper", {0.2, 0, 0});
  b.probe("span", "upper", {0.4, 0.1, 0});
  return b;
}

/// The torque jumps in the middle of the run, between two steps.
SceneBuilder pushed_arm() {
  SceneBuilder b = arm();
  initial_joint(b, "shoulder", 0.3, 1.5);
  b.scene.efforts.push_back({"shoulder", TimeFunction::parse("t < 0.4999999 ? 3 : -3"), {}});
  return b;
}

SceneBuilder driven_arm() {
  SceneBuilder b = arm();
  b.scene.motions.push_back({"shoulder", TimeFunction::parse("0.3*sin(4*t)"), {}});
  return b;
}

/// Output at multiples of kCoarsestStep, so that no stamp is within three steps after the start or the jump. The stamp
/// at the end of the step with the jump is left out: there, Newmark's accelerations contain only half of the jump.
struct Output {
  std::vector<double> rates, points, efforts;
};

Output output(const SceneBuilder& builder, const Scheme& scheme, int refinement) {
  Simulation simulation(builder.scene, options(std::string(scheme.name), kCoarsestStep / refinement, 1e-11));
  Output out;
  for (int n = 0; n < std::lround(kUntil / kCoarsestStep); ++n) {
    run(simulation, refinement);
    if (std::abs(simulation.time() - kJumpsAt) < 0.5 * kCoarsestStep) continue;
    for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
      out.rates.push_back(simulation.velocity(i));
      out.efforts.push_back(simulation.effort(i));
    }
    for (int i = 0; i < 2; ++i) {
      const ProbeState probe = simulation.probe(i);
      for (int k = 0; k < 3; ++k) out.points.push_back(probe.velocity[k]);
    }
  }
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Order of the error in the step, from three runs. The reference is extrapolated from the two finest of four runs.
double slope(const std::vector<Output>& runs, std::vector<double> Output::*quantity, int order) {
  const std::vector<double>&fine = runs[runs.size() - 1].*quantity, &coarser = runs[runs.size() - 2].*quantity;
  std::vector<double> reference = fine;
  const double factor = 1 / (std::pow(2.0, order) - 1);
  for (std::size_t i = 0; i < fine.size(); ++i) reference[i] += factor * (fine[i] - coarser[i]);
  const double error = distance(runs[0].*quantity, reference), finer = distance(runs[1].*quantity, reference);
  std::printf("  errors %.2e, %.2e, slope %.2f\n", error, finer, std::log2(error / finer));
  return std::log2(error / finer);
}

class PublishedOrder : public ::testing::TestWithParam<Scheme> {
 protected:
  std::vector<Output> runs(const SceneBuilder& builder) const {
    // For a scheme of first order, terms of second order are small only in finer steps than otherwise needed.
    const int coarsest = GetParam().order == 1 ? 64 : 16;
    std::vector<Output> out;
    for (const int finer : {1, 2, 8, 16}) out.push_back(output(builder, GetParam(), coarsest * finer));
    return out;
  }
};

TEST_P(PublishedOrder, VelocitiesUnderAJumpingTorque) {
  const int order = std::min(GetParam().order, 2);
  const std::vector<Output> results = runs(pushed_arm());
  EXPECT_GT(slope(results, &Output::rates, order), 0.9 * order);
  EXPECT_GT(slope(results, &Output::points, order), 0.9 * order);
}

TEST_P(PublishedOrder, VelocitiesAndEffortsOfAMotion) {
  const int order = std::min(GetParam().order, 2);
  const std::vector<Output> results = runs(driven_arm());
  EXPECT_GT(slope(results, &Output::rates, order), 0.9 * order);
  EXPECT_GT(slope(results, &Output::points, order), 0.9 * order);
  EXPECT_GT(slope(results, &Output::efforts, order), 0.9 * order);
}

INSTANTIATE_TEST_SUITE_P(Schemes, PublishedOrder, ::testing::ValuesIn(schemes()),
                         [](const auto& info) { return std::string(info.param.name); });

/// The effort that moves I = 1 along sin 3t is -9 sin 3t.
TEST(PublishedEffort, OfAnInertiaThatAMotionDrives) {
  SceneBuilder b;
  b.body("wheel", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("axle", scene::JointKind::Revolute, "world", "wheel");
  b.scene.motions.push_back({"axle", TimeFunction::parse("sin(3*t)"), {}});
  for (const Scheme& scheme : schemes()) {
    double error[2] = {};
    for (const int k : {0, 1}) {
      const double step = k == 0 ? 0.01 : 0.005;
      Simulation simulation(b.scene, options(std::string(scheme.name), step, 1e-11));
      // The formula needs three steps: a mean of two steps, and its change. If the scheme's root is not -1, the error
      // of the start must decay first.
      run(simulation, scheme.hht == HhtForm::None ? 3 : static_cast<int>(std::lround(1 / step)));
      run(simulation, static_cast<int>(std::lround(2 / step)),
          [&] { error[k] = std::max(error[k], std::abs(simulation.effort(0) + 9 * std::sin(3 * simulation.time()))); });
    }
    EXPECT_GT(std::log2(error[0] / error[1]), 1.8) << scheme.name << ": " << error[0] << ", " << error[1];
  }
}

// ---------------------------------------------------------------- every row of a smooth motion

/// A double pendulum in the x-z plane whose angles are counted upwards from the x axis.
struct DoublePendulum {
  double masses[2] = {1.6, 0.9}, centres[2] = {0.45, 0.35}, inertias[2] = {0.15, 0.08}, length = 0.9;
  Eigen::Vector4d start{0.5, -0.3, 0, 0};  // angle of the first bar, of the joint between both, and their rates

  SceneBuilder scene() const {
    SceneBuilder b;
    b.scene.gravity = {0, 0, -9.81};
    const char* const names[] = {"first", "second"};
    for (int i = 0; i < 2; ++i) {
      b.body(names[i], masses[i], {centres[i], 0, 0}, Vector3(0.01, inertias[i], inertias[i]).asDiagonal());
      b.joint(std::string(names[i]) + "_joint", scene::JointKind::Continuous, i == 0 ? "world" : names[0], names[i],
              {i * length, 0, 0}, {0, -1, 0});
      initial_joint(b, std::string(names[i]) + "_joint", start[i], start[2 + i]);
    }
    return b;
  }
  /// Lagrange's equations in the absolute angles.
  Eigen::VectorXd change(const Eigen::VectorXd& y) const {
    const double first = y[0], second = y[0] + y[1], rate = y[2], other = y[2] + y[3];
    const double coupling = masses[1] * length * centres[1], turn = first - second;
    Eigen::Matrix2d mass;
    mass << inertias[0] + masses[0] * centres[0] * centres[0] + masses[1] * length * length, coupling * std::cos(turn),
        coupling * std::cos(turn), inertias[1] + masses[1] * centres[1] * centres[1];
    const Eigen::Vector2d moment(
        -(masses[0] * centres[0] + masses[1] * length) * 9.81 * std::cos(first) -
            coupling * std::sin(turn) * other * other,
        -masses[1] * centres[1] * 9.81 * std::cos(second) + coupling * std::sin(turn) * rate * rate);
    const Eigen::Vector2d acceleration = mass.inverse() * moment;
    return Eigen::Vector4d(y[2], y[3], acceleration[0], acceleration[1] - acceleration[0]);
  }
};

/// Errors of a published rate in all rows but the first four, which follow from fewer than five steps.
std::vector<double> errors_of_rate(int joint, int steps) {
  const DoublePendulum pendulum;
  Simulation simulation(pendulum.scene().scene, options("em", 1.0 / steps, 1e-12));
  Eigen::VectorXd y = pendulum.start;
  std::vector<double> errors;
  for (int n = 1; n <= steps; ++n) {
    run(simulation, 1);
    y = solve_ode([&](double, const Eigen::VectorXd& at) { return pendulum.change(at); }, 0, 1.0 / steps, y);
    if (n > 4) errors.push_back(std::abs(simulation.velocity(joint) - y[2 + joint]));
  }
  return errors;
}

double largest_of(const std::vector<double>& errors) {
  return *std::max_element(errors.begin(), errors.end());
}

// The largest error of any row falls with the square of the step, and no row is much worse than its neighbours where
// the rate has an extremum.
TEST(PublishedVelocity, IsOfSecondOrderInEveryRow) {
  constexpr std::size_t kNear = 6;
  for (const int joint : {0, 1}) {
    const std::vector<double> coarse = errors_of_rate(joint, 200), finer = errors_of_rate(joint, 400),
                              fine = errors_of_rate(joint, 800);
    EXPECT_NEAR(std::log2(largest_of(coarse) / largest_of(finer)), 2, 0.2) << joint;
    EXPECT_NEAR(std::log2(largest_of(finer) / largest_of(fine)), 2, 0.2) << joint;
    const double small = 0.02 * largest_of(fine);  // beside the zeros of the error
    for (std::size_t n = kNear; n + kNear < fine.size(); ++n)
      ASSERT_LE(fine[n], 2 * (std::max(fine[n - kNear], fine[n + kNear]) + small)) << joint << ", row " << n;
  }
}

// ---------------------------------------------------------------- the guide's second arm

/// Shoulder velocity in rows, every millisecond for instance, and the increments of the position from row to row.
struct Velocities {
  std::vector<double> published, increments;
};
Velocities velocities(const std::string& scheme, double damping, int steps_per_row, double row = 1e-3,
                      int rows = 1200) {
  scene::SceneDescription scene = guide_arm();
  for (scene::LinkDescription& link : scene.links)
    if (link.beam) link.beam->stiffness_proportional_damping = damping;
  Simulation simulation(scene, options(scheme, row / steps_per_row));
  Velocities out;
  for (int n = 0; n < rows; ++n) {
    const double before = simulation.position(0);
    run(simulation, steps_per_row);
    out.published.push_back(simulation.velocity(0));
    out.increments.push_back((simulation.position(0) - before) / row);
  }
  return out;
}

/// Root mean square of a difference over stamps `from` to `to`. The stamps begin 10 ms after the start or the jump at 1
/// s, or at the jump.
double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t n = from; n < to; ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum / static_cast<double>(to - from));
}

// After a jump of the motor's torque, waves that are much shorter than a step run along the arm. In the 10 ms after the
// jump, the error of published velocities is at most that of differences of positions. (If changes of the rate do not
// agree, the published velocity is such a difference.)
TEST(PublishedVelocity, IsNoWorseThanIncrementsBehindAJumpOfTorque) {
  constexpr double kSame = 1e-2;  // equal, except for steps whose changes agree by chance
  for (const double damping : {1e-3, 1e-4}) {
    const Velocities fine = velocities("em", damping, 50);
    double speed = 0;
    for (std::size_t n = 1000; n < 1010; ++n) speed += 0.1 * fine.published[n] * fine.published[n];
    for (const char* scheme : {"em", "em0", "edmc2", "newmark", "hht2", "hht3"}) {
      const Velocities coarse = velocities(scheme, damping, 1);
      const double published = difference(coarse.published, fine.published, 1000, 1010),
                   increments = difference(coarse.increments, fine.published, 1000, 1010);
      std::printf("%s, damping %g s, behind the jump: published %.3f, increments %.3f of the rms speed\n", scheme,
                  damping, published / std::sqrt(speed), increments / std::sqrt(speed));
      EXPECT_LT(published, increments * (1 + kSame)) << scheme << ", " << damping << " s";
    }
  }
}

// The same with steps of 0.1 ms, which resolve part of the waves: their rates have extrema, too.
TEST(PublishedVelocity, IsNoWorseThanIncrementsBehindAJumpOfTorqueInShortSteps) {
  for (const double damping : {1e-3, 1e-4}) {
    const Velocities fine = velocities("em", damping, 5, 1e-4, 10100),
                     coarse = velocities("em", damping, 1, 1e-4, 10100);
    const double published = difference(coarse.published, fine.published, 10000, 10100),
                 increments = difference(coarse.increments, fine.published, 10000, 10100);
    std::printf("em, damping %g s, steps of 0.1 ms, behind the jump: published %.3f, increments %.3f rad/s\n", damping,
                published, increments);
    EXPECT_LT(published, increments * (1 + 1e-2)) << damping << " s";
  }
}

// The jump excites modes that no step resolves, and the scheme's own velocities keep this oscillation forever. Plain
// increments, which a user could take instead, do not oscillate but lag by half a step.
TEST(PublishedVelocity, DoesNotRingAfterAJumpOfTorque) {
  for (const auto& [scheme, damping] :
       {std::pair<std::string, double>{"em", 1e-3}, {"em", 1e-4}, {"edmc2", 1e-3}, {"edmc2", 1e-4}}) {
    const Velocities fine = velocities("em", damping, 50), coarse = velocities(scheme, damping, 1);
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{10, 999}, {1010, 1200}}) {
      const double published = difference(coarse.published, fine.published, from, to),
                   increments = difference(coarse.increments, fine.published, from, to);
      std::printf("%s, damping %g s, from %zu ms: published %.2e, increments %.2e\n", scheme.c_str(), damping, from,
                  published, increments);
      EXPECT_LT(published, increments) << scheme << ", " << damping << " s, from " << from << " ms";
    }
  }
}

}  // namespace
}  // namespace flexarm::test
