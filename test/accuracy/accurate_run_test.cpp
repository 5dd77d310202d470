// Tests runs to a given accuracy: their errors against finer runs, their choice of steps and schemes, and how they end.
#include "flexarm/accuracy/accurate_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accuracy/falling_arm.h"
#include "flexarm/scene/point_spring.h"
#include "support/scene_builder.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

/// The motion in equal steps, `steps` per interval.
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
    // The estimate neglects only the next power of the step, so it is accurate to a fraction of the error.
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

/// A weak spring between two points, which explicit schemes do not have.
void hinder_explicit_schemes(SceneBuilder& b) {
  auto spring = std::make_shared<scene::PointSpring>();
  spring->name = "spring", spring->from = "world", spring->to = "fore";
  spring->from_at = {0, 0, 2};
  spring->stiffness = 0.1;
  b.scene.force_elements.push_back(spring);
}

/// If the scene does not fix the scheme, a scheme of fourth order needs fewer steps for a small error. The simulation
/// keeps its own scheme, and continues from the end of the run.
TEST(AccurateRun, TakesASchemeOfHigherOrderWhereItMay) {
  constexpr double kAccuracy = 1e-6, kUntil = 1;
  long steps = 0;
  for (const char* scheme : {"auto", "em"}) {
    SceneBuilder b = falling_links();
    hinder_explicit_schemes(b);
    b.scene.integrator.scheme = scheme;
    Simulation simulation(b.scene);
    const std::size_t shoulder = *simulation.find_coordinate("shoulder");
    simulation.command_effort(shoulder, 3);
    const double start = simulation.energies().total();
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
    EXPECT_NEAR(energies.total() - energies.work, start, kAccuracy * energies.kinetic) << "the account goes on";
    // Commands are still active: the next step agrees with the one of the other run, to the accuracy.
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_TRUE(fine.step().converged);
    EXPECT_EQ(simulation.effort(shoulder), 3);
    EXPECT_LT((simulation.probe_pose(0).position - fine.probe_pose(0).position).norm(), 2 * kAccuracy * run.scale);
  }
}

/// Rigid links without stiff parts take an explicit scheme, unless the scene names another one. The simulation keeps
/// its own scheme, and continues from the end of the run. The reference is of another kind, em4.
TEST(AccurateRun, TakesAnExplicitSchemeForRigidLinks) {
  constexpr double kUntil = 1;
  SceneBuilder b = falling_links();
  SceneBuilder fine = b;
  fine.scene.integrator.scheme = "em4";
  const JudgedMotion reference = reference_motion(fine, kUntil, 100, 20);
  b.scene.integrator.scheme = "auto";
  for (const double accuracy : {1e-3, 1e-6, 1e-8}) {
    Simulation simulation(b.scene);
    RunWatcher nobody;
    const AccurateRun run = run_to_accuracy(simulation, {accuracy, kUntil}, nobody);
    SCOPED_TRACE(tries_of(run));
    ASSERT_EQ(run.end, AccurateRun::End::Met);
    EXPECT_TRUE(run.scheme() == "rk4" || run.scheme() == "dop853") << run.scheme();
    EXPECT_LE(motion_error(run.motion, reference, run.scale), accuracy);
    EXPECT_EQ(simulation.scheme(), "em");
    EXPECT_NEAR(simulation.time(), kUntil, 1e-12);
    EXPECT_LT((simulation.probe_pose(0).position - run.motion.points[0].back()).norm(), 1e-12);
    const Energies energies = simulation.energies();
    EXPECT_NEAR(energies.total() - energies.work, 0, accuracy * energies.kinetic) << "the account goes on";
    EXPECT_TRUE(simulation.step().converged);
  }
}

/// A damper that is stiff: explicit steps would have to be shorter than 2.8 J / c, about 1e-6 s. Their tries cost no
/// more than those of the schemes that are taken instead.
TEST(AccurateRun, GivesWayWhereExplicitSchemesAreStiff) {
  constexpr double kAccuracy = 1e-4, kUntil = 1;
  SceneBuilder b = falling_links();
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.name == "elbow") joint.damping = 1e5;
  SceneBuilder fine = b;
  fine.scene.integrator.scheme = "em";
  const JudgedMotion reference = reference_motion(fine, kUntil, 100, 100);
  b.scene.integrator.scheme = "auto";
  Simulation simulation(b.scene);
  RunWatcher nobody;
  const AccurateRun run = run_to_accuracy(simulation, {kAccuracy, kUntil}, nobody);
  SCOPED_TRACE(tries_of(run));
  ASSERT_EQ(run.end, AccurateRun::End::Met);
  EXPECT_TRUE(run.scheme() == "em" || run.scheme() == "em4") << run.scheme();
  EXPECT_LE(motion_error(run.motion, reference, run.scale), kAccuracy);
  long implicit = 0;
  for (const AccurateRun::Try& one : run.tries)
    if (one.scheme == "em" || one.scheme == "em4") implicit += one.steps;
  EXPECT_LT(run.steps - implicit, 5 * implicit) << "steps of rk4 take a quarter of the time";
}

/// A try of fourth order is compared with the limit of two tries of second order, so it needs no second try. The error
/// of this limit, which is also of fourth order, is part of the estimate.
TEST(AccurateRun, IsJudgedByTheLimitOfTheOtherScheme) {
  constexpr double kAccuracy = 1e-5, kUntil = 1;
  constexpr int kIntervals = 50;
  SceneBuilder b = falling_links();
  hinder_explicit_schemes(b);
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

/// The middle part of a step of em4 goes backwards by the fraction 4 p - 1 of it, p = 1 / (4 - 4^(1/3)). There, a
/// strain has the stiffness 1/2 - beta / h of its beam, with the part's length h and the damping beta. It vanishes for
/// h = 2 beta. If h is a little shorter, it is negative, and the beam gives way. Steps of this length have larger
/// errors than steps of twice the length.
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
  // The same limit relative to the steps of the first try, which has one in each of the hundred intervals.
  request.most_steps = 1e8;
  request.most_refinement = 5;
  Simulation other(b.scene);
  const AccurateRun relative = run_to_accuracy(other, request, nobody);
  EXPECT_EQ(relative.end, AccurateRun::End::OutOfSteps);
  EXPECT_LE(relative.steps, 500);
  EXPECT_NE(shortcoming(relative, 1e-6).find("more steps are needed"), std::string::npos);
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

/// One iteration is not enough for a step.
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

/// Keeps the times at the ends of the last try's steps.
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

/// A servo samples every 10 ms. Its samples must be at ends of steps, whatever the intervals are.
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

}  // namespace
}  // namespace flexarm::test
