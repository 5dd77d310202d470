#include "flexarm/accuracy/accurate_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "flexarm/accuracy/companion.h"
#include "flexarm/scene/urdf_reader.h"
#include "math/pi.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

/// Two beams of two elements that hang on hinges and fall from the horizontal, not in one plane.
SceneBuilder falling_arm() {
  SceneBuilder b;
  const scene::DirectSection soft = section(4e3, 2e3, 40, 60, 1, 0.01, 0.005);
  b.beam("upper", {{1, 0, 0}}, soft, 2, 2);
  b.beam("fore", {{0, 0.8, 0}}, soft, 2, 2);
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.joint("elbow", scene::JointKind::Revolute, "upper", "fore", {1, 0, 0}, Vector3::UnitX());
  b.probe("tip", "fore", {0, 0.8, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = 1e-10;
  return b;
}

/// Two rigid links: without fast modes, so that orders are seen at any step.
SceneBuilder falling_links() {
  SceneBuilder b;
  Matrix3 inertia = Vector3(0.02, 0.03, 0.04).asDiagonal();
  b.body("upper", 1, {0.5, 0, 0}, inertia);
  b.body("fore", 0.7, {0, 0.4, 0}, inertia);
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.joint("elbow", scene::JointKind::Revolute, "upper", "fore", {1, 0, 0}, Vector3::UnitX());
  b.probe("tip", "fore", {0, 0.8, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

/// The motion in equal steps.
JudgedMotion reference_motion(const SceneBuilder& b, double until, int intervals, int steps) {
  Simulation simulation(b.scene);
  simulation.set_step_size(until / intervals / steps);
  const JudgedPoints points(simulation);
  JudgedMotion motion(points.size());
  motion.add(points.positions(simulation));
  for (int i = 0; i < intervals; ++i) {
    for (int n = 0; n < steps; ++n) EXPECT_TRUE(simulation.step().converged);
    motion.add(points.positions(simulation));
  }
  return motion;
}

std::string tries_of(const AccurateRun& run) {
  std::string text = to_string(run.end);
  for (const AccurateRun::Try& one : run.tries)
    text += "; " + std::to_string(one.steps) + " steps: " + std::to_string(1e9 * one.estimate) + "e-9";
  return text;
}

TEST(AccurateRun, HasTheErrorThatWasAskedFor) {
  const SceneBuilder b = falling_arm();
  constexpr double kUntil = 1.5;
  constexpr int kIntervals = 10;
  const JudgedMotion reference = reference_motion(b, kUntil, kIntervals, 2000);
  long steps = 0;
  for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
    Simulation simulation(b.scene);
    RunWatcher nobody;
    const AccurateRun run = run_to_accuracy(simulation, {accuracy, kUntil, kIntervals}, nobody);
    EXPECT_GT(run.tries.back().steps, std::exchange(steps, run.tries.back().steps)) << "nothing is asked for";
    ASSERT_EQ(run.end, AccurateRun::End::Met) << accuracy;
    const double error = motion_error(run.motion, reference, run.scale);
    EXPECT_LE(run.estimate(), accuracy);
    EXPECT_LE(error, accuracy);
    // The next power of the step is all that the estimate leaves out: it knows the error to a part of itself.
    EXPECT_NEAR(run.estimate(), error, 0.5 * error) << accuracy;
    EXPECT_NEAR(simulation.time(), kUntil, 1e-12);
    EXPECT_EQ(simulation.step_size(), b.scene.integrator.step) << "as it was before";
    std::printf("asked for %.0e: error %.2e, estimate %.2e, %ld steps of the last try, %ld in all\n", accuracy, error,
                run.estimate(), run.tries.back().steps, run.steps);
  }
}

TEST(AccurateRun, ErrorsInChangingStepsFallWithTheOrderOfTheScheme) {
  const SceneBuilder b = falling_links();
  for (const auto& [scheme, order] : {std::pair("em", 2), {"newmark", 2}, {"em4", 4}}) {
    SceneBuilder with = b;
    with.scene.integrator.scheme = scheme;
    const auto motion = [&](int refinement) {
      Simulation simulation(with.scene);
      const JudgedPoints points(simulation);
      JudgedMotion made(points.size());
      made.add(points.positions(simulation));
      for (int i = 0; i < 20; ++i) {
        const int steps = refinement * (i % 4 == 1 ? 4 : i % 4 == 3 ? 1 : 2);  // changes all the time
        simulation.set_step_size(0.05 / steps);
        for (int n = 0; n < steps; ++n) EXPECT_TRUE(simulation.step().converged);
        made.add(points.positions(simulation));
      }
      return made;
    };
    const JudgedMotion fine = motion(32);
    const double coarse = motion_error(motion(4), fine, 1), finer = motion_error(motion(8), fine, 1);
    EXPECT_NEAR(std::log2(coarse / finer), order, 0.25) << scheme;
  }
}

/// Where the scene leaves the scheme open, one of fourth order needs fewer steps for a small error; the simulation
/// keeps its own, and goes on from the end of the run.
TEST(AccurateRun, TakesASchemeOfHigherOrderWhereItMay) {
  constexpr double kAccuracy = 1e-6, kUntil = 1;
  long steps = 0;
  for (const char* scheme : {"auto", "em"}) {
    SceneBuilder b = falling_links();
    b.scene.integrator.scheme = scheme;
    Simulation simulation(b.scene);
    const std::size_t shoulder = *simulation.find_coordinate("shoulder");
    simulation.command_effort(shoulder, 3);
    RunWatcher nobody;
    const AccurateRun run = run_to_accuracy(simulation, {kAccuracy, kUntil}, nobody);
    ASSERT_EQ(run.end, AccurateRun::End::Met) << tries_of(run);
    SCOPED_TRACE(std::string(scheme) + ": " + tries_of(run));
    const bool is_auto = std::string(scheme) == "auto";
    EXPECT_EQ(run.scheme(), is_auto ? "em4" : "em");
    EXPECT_EQ(simulation.scheme(), "em");
    if (!is_auto) {
      EXPECT_LT(steps, 0.5 * static_cast<double>(run.steps)) << "nothing is gained";
    }
    steps = run.steps;

    b.scene.integrator.scheme = "em4";
    Simulation fine(b.scene);
    fine.command_effort(shoulder, 3);
    const AccurateRun reference = run_to_accuracy(fine, {0.1 * kAccuracy, kUntil}, nobody);
    ASSERT_EQ(reference.end, AccurateRun::End::Met) << tries_of(reference);
    EXPECT_LE(motion_error(run.motion, reference.motion, run.scale), kAccuracy);

    EXPECT_NEAR(simulation.time(), kUntil, 1e-12);
    EXPECT_LT((simulation.probe_pose(0).position - run.motion.points[0].back()).norm(), 1e-12);
    const Energies energies = simulation.energies();
    EXPECT_NEAR(energies.total() - energies.work, 0, kAccuracy * energies.kinetic) << "the account goes on";
    // Commands are still there: the step after the run agrees with that of the other run to its error.
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_TRUE(fine.step().converged);
    EXPECT_EQ(simulation.effort(shoulder), 3);
    EXPECT_LT((simulation.probe_pose(0).position - fine.probe_pose(0).position).norm(), 2 * kAccuracy * run.scale);
  }
}

/// A try of fourth order is judged by what two of second order tend to: it needs no second one. What that limit errs
/// itself, in the fourth order, too, is in the estimate.
TEST(AccurateRun, IsJudgedByTheLimitOfTheOtherScheme) {
  constexpr double kAccuracy = 1e-5, kUntil = 1;
  constexpr int kIntervals = 50;
  SceneBuilder b = falling_links();
  b.scene.integrator.scheme = "auto";
  Simulation simulation(b.scene);
  struct Estimates : RunWatcher {
    double last = std::nan("");
    void after_interval(const Simulation&, double estimate) override { last = estimate; }
  } estimates;
  const AccurateRun run = run_to_accuracy(simulation, {kAccuracy, kUntil, kIntervals}, estimates);
  SCOPED_TRACE(tries_of(run));
  ASSERT_EQ(run.end, AccurateRun::End::Met);
  ASSERT_EQ(run.tries.size(), 3U);
  EXPECT_EQ(run.tries[1].scheme, "em");
  EXPECT_EQ(run.tries[2].scheme, "em4");
  EXPECT_EQ(run.tries[2].steps, kIntervals);

  SceneBuilder fine = b;
  fine.scene.integrator.scheme = "em4";
  const JudgedMotion reference = reference_motion(fine, kUntil, kIntervals, 20);
  EXPECT_LE(motion_error(run.motion, reference, run.scale), run.estimate());
  EXPECT_GT(estimates.last, 0) << "each interval has an estimate, too";
}

/// The middle part of a step of em4 goes backwards by 4 p - 1 of it, p = 1 / (4 - 4^(1/3)). A strain has the stiffness
/// 1/2 - beta / h of its beam there, h the part's length and beta its damping: none where h = 2 beta, and less where h
/// is a little shorter, so that the beam gives way. Steps of that length are worse than those that are twice as long.
TEST(AccurateRun, DoesNotBelieveStepsThatGoBackwardsThroughDamping) {
  constexpr double kAccuracy = 2e-5, kInterval = 0.06;
  constexpr int kIntervals = 25;
  const double part = 4 / (4 - std::cbrt(4.0)) - 1;
  SceneBuilder b = falling_arm();
  for (scene::LinkDescription& link : b.scene.links)
    if (link.beam) link.beam->stiffness_proportional_damping = 1.03 * part * (kInterval / 2) / 2;
  const JudgedMotion reference = reference_motion(b, kIntervals * kInterval, kIntervals, 200);
  b.scene.integrator.scheme = "em4";
  struct Tries : RunWatcher {
    explicit Tries(const JudgedPoints& judged) : points(judged) {}
    void begin(const Simulation&, long, double) override { motions.emplace_back(points.size()); }
    void after_interval(const Simulation& simulation, double) override {
      motions.back().add(points.positions(simulation));
    }
    const JudgedPoints& points;
    std::vector<JudgedMotion> motions;
  };
  Simulation simulation(b.scene);
  const JudgedPoints points(simulation);
  Tries tries(points);
  const AccurateRun run = run_to_accuracy(simulation, {kAccuracy, kIntervals * kInterval, kIntervals}, tries);
  SCOPED_TRACE(tries_of(run));
  ASSERT_EQ(run.end, AccurateRun::End::Met);
  ASSERT_GE(run.tries.size(), 3U);
  EXPECT_EQ(run.tries[1].steps, 2 * kIntervals);
  EXPECT_TRUE(std::isnan(run.tries[1].estimate));
  const auto error = [&](std::size_t i) { return motion_error(tries.motions[i], reference, run.scale); };
  EXPECT_GT(error(1), error(0)) << "nothing is wrong with them: this tests nothing";
  EXPECT_LE(motion_error(run.motion, reference, run.scale), kAccuracy);
}

TEST(AccurateRun, EndsWithWhatWasReached) {
  const SceneBuilder b = falling_arm();
  RunWatcher nobody;
  {
    Simulation simulation(falling_links().scene);
    AccuracyRequest request{1e-16, 0.5};
    request.intervals = 5;
    const AccurateRun run = run_to_accuracy(simulation, request, nobody);
    EXPECT_EQ(run.end, AccurateRun::End::NoConvergence) << tries_of(run);
    EXPECT_LT(run.estimate(), 1e-6);
    EXPECT_TRUE(run.last.converged);
  }
  AccuracyRequest request{1e-6, 0.2};
  request.most_steps = 500;
  Simulation simulation(b.scene);
  const AccurateRun run = run_to_accuracy(simulation, request, nobody);
  EXPECT_EQ(run.end, AccurateRun::End::OutOfSteps);
  EXPECT_LE(run.steps, 500);
  EXPECT_LT(run.estimate(), 1);
}

TEST(AccurateRun, RefusesWhatCannotBe) {
  const SceneBuilder b = falling_arm();
  RunWatcher nobody;
  Simulation simulation(b.scene);
  for (const AccuracyRequest& odd :
       {AccuracyRequest{0, 1}, {1, 1}, {1e-3, 0}, {1e-3, 1, 0}, {1e-3, 1, 100, 0.0}, {1e-3, 1, 100, {}, "nobody"}})
    EXPECT_THROW(run_to_accuracy(simulation, odd, nobody), std::invalid_argument);
  EXPECT_THROW(simulation.set_step_size(0), std::invalid_argument);
  EXPECT_THROW(simulation.set_step_size(std::nan("")), std::invalid_argument);
}

/// One iteration does not solve a step.
TEST(AccurateRun, EndsWhereStepsFail) {
  SceneBuilder b = falling_arm();
  b.scene.integrator.max_iterations = 1;
  b.scene.integrator.max_halvings = 0;
  RunWatcher nobody;
  Simulation simulation(b.scene);
  const AccurateRun run = run_to_accuracy(simulation, {1e-9, 1}, nobody);
  EXPECT_EQ(run.end, AccurateRun::End::Failed);
  EXPECT_FALSE(run.last.converged);
  EXPECT_TRUE(std::isnan(run.estimate()));
}

TEST(AccurateRun, IsInterrupted) {
  struct Impatient : RunWatcher {
    int left = 500;
    bool after_step(const Simulation&, const StepResult&) override { return --left > 0; }
  } impatient;
  Simulation simulation(falling_arm().scene);
  const AccurateRun run = run_to_accuracy(simulation, {1e-5, 1}, impatient);
  EXPECT_EQ(run.end, AccurateRun::End::Interrupted);
}

/// When steps of the last try have ended.
struct EndsOfSteps : RunWatcher {
  std::vector<double> times;
  void begin(const Simulation&, long, double) override { times.clear(); }
  bool after_step(const Simulation& simulation, const StepResult&) override {
    times.push_back(simulation.time());
    return true;
  }
  bool has(double time) const {
    return std::any_of(times.begin(), times.end(), [time](double end) { return std::abs(end - time) < 1e-12; });
  }
};

/// A servo that measures every 10 ms is measured at ends of steps, whatever intervals are.
TEST(AccurateRun, HitsSamples) {
  SceneBuilder b = falling_arm();
  scene::ServoDescription& servo = b.servo("shoulder", 5, 0.2);
  servo.sample_time = 0.01;
  b.scene.integrator.step = 0.01;
  for (const double until : {1.3, 0.9123}) {
    EndsOfSteps ends;
    Simulation simulation(b.scene);
    AccuracyRequest request{1e-3, until};
    request.most_steps = 1e5;
    const AccurateRun run = run_to_accuracy(simulation, request, ends);
    EXPECT_EQ(run.end, AccurateRun::End::Met) << tries_of(run);
    EXPECT_NEAR(simulation.time(), until, 1e-12);
    for (int n = 1; n < until / 0.01; ++n) ASSERT_TRUE(ends.has(n * 0.01)) << n;
    EXPECT_THROW(simulation.set_step_size(0.007), std::invalid_argument);
  }
}

// ---------------------------------------------------------------- the companion

TEST(Companion, KnowsTheErrorOfWhatRuns) {
  const SceneBuilder b = falling_arm();
  constexpr int kSteps = 300;
  constexpr double kStep = 0.004;
  Simulation simulation(b.scene), reference(b.scene);
  simulation.set_step_size(kStep);
  reference.set_step_size(kStep / 16);
  Companion companion(simulation);
  double estimate = std::nan(""), error = 0;
  for (int n = 0; n < kSteps; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
    EXPECT_EQ(std::isnan(estimate), n == 0);
    for (int k = 0; k < 16; ++k) ASSERT_TRUE(reference.step().converged);
    error = std::max(error, (simulation.probe(0).pose.position - reference.probe(0).pose.position).norm());
  }
  EXPECT_NEAR(estimate, error, 0.3 * error);
}

/// Efforts that change from step to step have the same impulse for it: what they do to a mass is known exactly.
TEST(Companion, FollowsCommands) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  Simulation simulation(b.scene);
  Companion companion(simulation);
  double estimate = 0;
  for (int n = 0; n < 200; ++n) {
    simulation.command_effort(0, std::sin(0.3 * n));
    simulation.apply_wrenches({{1, Vector3::Zero(), {{0.1 * n, 0, 0}, Vector3::Zero()}, false}});
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
  }
  // The acceleration changes once in a step of the companion, which its mean moves by h^2 / 2 of the change.
  const double change = 0.5 * (0.3 + 0.1) / 2 * 1e-6;
  EXPECT_GT(estimate, 0);
  EXPECT_LE(estimate, 100 * change / 3);
}

/// The largest of estimates, and of distances from where a block on a rail is to be at the time.
struct Judged {
  double estimate = 0, error = 0;
};
template <class Position>
Judged follow_block(const SceneBuilder& b, double until, const Position& position) {
  Simulation simulation(b.scene);
  Companion companion(simulation);
  Judged out;
  for (int n = std::lround(until / simulation.step_size()); n > 0; --n) {
    EXPECT_TRUE(simulation.step().converged);
    const double estimate = companion.follow(simulation);
    if (!std::isnan(estimate)) out.estimate = estimate;
    out.error = std::max(out.error, std::abs(simulation.position(0) - position(simulation.time())));
  }
  return out;
}

SceneBuilder block_at(double position, double velocity) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  b.scene.initial_joints.push_back({"rail", position, velocity, {}});
  b.scene.gravity = Vector3::Zero();
  b.scene.integrator.step = 0.01;
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

// An effort that turns from 6 N to -6 N somewhere in a step: 3 m/s^2 of 2 kg, so that a step is off by 6 m/s^2 h/2 at
// most.
TEST(Companion, CountsJumpsWithinItsSteps) {
  const double h = 0.01, until = 1;
  for (int k = 0; k < 16; ++k) {
    const double jump = 0.3 + h * k / 7.5 + 1e-6;
    SceneBuilder b = block_at(0, 0);
    b.scene.efforts.push_back({"rail", TimeFunction::parse("t < " + std::to_string(jump) + " ? 6 : -6"), {}});
    const Judged judged = follow_block(b, until, [&](double t) {
      return t < jump ? 1.5 * t * t : 1.5 * jump * jump + 3 * jump * (t - jump) - 1.5 * (t - jump) * (t - jump);
    });
    const double bound = 0.5 * 6 * h * (until - jump);
    EXPECT_GE(judged.estimate, judged.error) << jump;
    EXPECT_LE(judged.error, 1.1 * bound) << jump;
    EXPECT_LE(judged.estimate, 2.2 * bound) << jump;  // what the companion differs by comes in addition
  }
}

// Pushed by less than friction holds: it comes to rest after v^2/(2 a) and stays there.
TEST(Companion, CountsWhereFrictionBringsToRest) {
  for (const double start : {0.3, 0.317, 0.335, 0.349}) {
    SceneBuilder b = block_at(0, start);
    b.scene.joints[0].friction = 2;
    b.scene.joints[0].friction_law.law = scene::FrictionDescription::Law::Coulomb;
    const Judged judged = follow_block(b, 1, [&](double t) {
      const double s = std::min(t, start / 1.0);
      return start * s - 0.5 * s * s;
    });
    EXPECT_GE(judged.estimate, judged.error) << start;
    EXPECT_LE(judged.estimate, 1.0 * 0.01) << "a velocity of 1 m/s^2 h for a second" << start;
  }
}

// A motor at its limit until the error is small, then a spring: 4 m/s^2 until 0.1 m are left, and 40/s^2 of it then.
TEST(Companion, CountsWhereAMotorLeavesItsLimit) {
  for (const double target : {0.5, 0.513, 0.527, 0.541}) {
    SceneBuilder b = block_at(0, 0);
    scene::ServoDescription& servo = b.servo("rail", 80, 0, 0);
    servo.set_point = TimeFunction(target);
    servo.effort_limit = 8;
    const double free = std::sqrt(2 * (target - 0.1) / 4), rate = 4 * free, w = std::sqrt(40.0);
    const double until = free + 0.9 * (kPi - 2 * std::atan2(rate / w, 0.1)) / w;  // before the limit on the other side
    const Judged judged = follow_block(b, std::floor(until / 0.02) * 0.02, [&](double t) {
      return t < free ? 2 * t * t : target - 0.1 * std::cos(w * (t - free)) + rate / w * std::sin(w * (t - free));
    });
    EXPECT_GE(judged.estimate, judged.error) << target;
  }
}

// Smooth motions of what might have corners are judged as those of what has none.
TEST(Companion, NoCornerNoDoubt) {
  SceneBuilder plain = falling_links(), with = falling_links();
  with.scene.joints[0].limits = scene::JointLimits{-3, 3};
  with.scene.efforts.push_back({"elbow", TimeFunction(0.0), {}});
  std::array<double, 2> estimates{};
  for (std::size_t i = 0; i < 2; ++i) {
    Simulation simulation((i == 0 ? plain : with).scene);
    Companion companion(simulation);
    for (int n = 0; n < 300; ++n) {
      ASSERT_TRUE(simulation.step().converged);
      estimates[i] = companion.follow(simulation);
    }
  }
  EXPECT_NEAR(estimates[0] / estimates[1], 1, 1e-6);
}

// Of a corner in the first steps nothing is known.
TEST(Companion, SaysWhatItDoesNotKnow) {
  SceneBuilder b = block_at(0, 0);
  b.scene.efforts.push_back({"rail", TimeFunction::parse("t < 0.014 ? 6 : -6"), {}});
  Simulation simulation(b.scene);
  Companion forever(simulation), windowed(simulation, 0.2);
  double estimate = 0;
  for (int n = 0; n < 50; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    if (n >= 4) {
      EXPECT_TRUE(std::isnan(forever.follow(simulation))) << n;
    } else {
      forever.follow(simulation);
    }
    estimate = windowed.follow(simulation);
  }
  EXPECT_FALSE(std::isnan(estimate)) << "another window has begun";
}

TEST(Companion, BeginsAgainWhereTheSimulationIsPut) {
  Simulation simulation(falling_arm().scene);
  Companion companion(simulation, 0.05);
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    companion.follow(simulation);
  }
  simulation.reset();
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_TRUE(std::isnan(companion.follow(simulation)));
  ASSERT_TRUE(simulation.step().converged);
  companion.follow(simulation);
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_LT(companion.follow(simulation), 1e-6) << "a step or two are nearly exact";
}

TEST(Companion, RefusesAWindowOfNoLength) {
  const Simulation simulation(falling_arm().scene);
  for (const double window : {0.0, -1.0, double(NAN)})
    EXPECT_THROW(Companion(simulation, window), std::invalid_argument) << window;
}

}  // namespace
}  // namespace flexarm::test
