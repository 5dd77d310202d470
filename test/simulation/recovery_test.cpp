// Tests recovery of steps: they are counted, done by another scheme if that is allowed, and limited in wall-clock time.
#include <cmath>

#include "integrators/dissipative_substitute.h"
#include "integrators/energies.h"
#include "simulation/everything_scene.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using Reason = StepResult::Reason;

/// A stiff cantilever under a step force, with steps of several periods of its lowest mode, 1.8 s.
scene::SceneDescription stiff_cantilever(double force, double step) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e5, 3.5e4, 0.8, 1, 1, 2e-5, 1e-5), 8, 2);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 0, force});
  b.scene.gravity.setZero();
  b.scene.integrator.step = step;
  b.scene.integrator.max_halvings = 0;
  return b.scene;
}

struct Outcome {
  StepCounts counts;
  bool converged = true;
  double defect = 0;  // largest change of total energy - work + dissipation [J]
};

Outcome outcome_of(Simulation& simulation, int steps) {
  Outcome out;
  const double start = energy_account(simulation);
  for (int n = 0; n < steps && out.converged; ++n) {
    const StepResult result = simulation.step();
    out.counts.add(result);
    out.converged = result.converged;
    out.defect = std::max(out.defect, std::abs(energy_account(simulation) - start));
  }
  return out;
}

TEST(Recovery, EdmcDoesWhatTheSchemeCannotWhereThatIsAllowed) {
  int saved_runs = 0;
  for (const double step : {1.8, 3.6, 8.9, 35.7})
    for (const int max_iterations : {5, 6, 8, 20}) {
      scene::SceneDescription scene = stiff_cantilever(1, step);
      scene.integrator.max_iterations = max_iterations;
      Simulation stops(scene);
      if (outcome_of(stops, 60).converged) continue;
      scene.integrator.on_failure = OnFailure::Dissipate;
      Simulation dissipates(scene);
      const Outcome saved = outcome_of(dissipates, 60);
      EXPECT_TRUE(state_of(dissipates).strain_memory.empty()) << "em has none";
      // Round-off: that of strains is 1e-16 over an element's length; it is multiplied by axial forces, EA times
      // strains of 1e-2, over some hundred steps. Energies are 0.1 J.
      EXPECT_LT(saved.defect, 1e-9) << step << ' ' << max_iterations;
      if (!saved.converged) continue;
      ++saved_runs;
      EXPECT_GT(saved.counts.dissipated_steps, 0);
      EXPECT_LT(saved.counts.dissipated_steps, 60);
    }
  EXPECT_GT(saved_runs, 0) << "this test wants scenes that em cannot do in so long steps";
}

/// A free beam that tumbles.
scene::SceneDescription tumbling_beam(const std::string& scheme, double damping) {
  SceneBuilder b;
  b.beam("beam", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 4, 2).stiffness_proportional_damping = damping;
  b.joint("free", JointKind::Floating, "world", "beam");
  b.scene.initial_links.push_back({"beam", {1, 0, 0}, {0, 3, 5}, {}});
  b.scene.gravity.setZero();
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = 0.01;
  return b.scene;
}

TEST(Recovery, AccountAndMomentaAreExactOverTheChangeOfSchemes) {
  for (const char* name : {"em", "em_symmetric", "em4"})
    for (const double damping : {0.0, 1e-3}) {
      const Simulation simulation(tumbling_beam(name, damping));
      const Model& model = model_of(simulation);
      const Scheme scheme = make_scheme(simulation.scene().integrator);
      StepSettings settings;
      settings.step = simulation.step_size();
      Stepper stepper(model, scheme, settings);
      DissipativeSubstitute substitute(model, scheme, settings);
      State state = state_of(simulation);
      const auto account = [&] {
        const Energies e = energies(model, scheme, state);
        return e.total() - e.work + e.dissipated;
      };
      const double energy = account();
      const Momenta start = momenta(model, scheme, state);
      const std::size_t memories = state.strain_memory.size();
      for (int n = 0; n < 90; ++n) {
        StepResult result;
        if (n % 3 != 2) {
          result = stepper.advance(state);
        } else {
          substitute.keep(state);
          EXPECT_TRUE(substitute.advance(state, Deadline(0), result) && result.is_dissipated);
          stepper.invalidate();
        }
        ASSERT_TRUE(result.converged) << name;
      }
      // Bound: round-off of 90 steps.
      EXPECT_NEAR(account(), energy, 1e-11 * energy) << name << ' ' << damping;
      const Momenta end = momenta(model, scheme, state);
      EXPECT_LT((end.linear - start.linear).norm(), 1e-11 * start.linear.norm()) << name;
      EXPECT_LT((end.angular - start.angular).norm(), 1e-11 * start.angular.norm()) << name;
      EXPECT_EQ(state.strain_memory.size(), memories) << "as the scheme has it";
      EXPECT_NEAR(state.time, 0.9, 1e-12);
    }
}

TEST(Recovery, NothingIsDissipatedWhereNothingFails) {
  scene::SceneDescription scene = stiff_cantilever(1, 0.01);
  Simulation stops(scene);
  scene.integrator.on_failure = OnFailure::Dissipate;
  Simulation dissipates(scene);
  const Outcome one = outcome_of(stops, 50), other = outcome_of(dissipates, 50);
  ASSERT_TRUE(one.converged && other.converged);
  EXPECT_EQ(other.counts.dissipated_steps, 0);
  for (std::size_t i = 0; i < state_of(stops).nodes.size(); ++i)
    EXPECT_EQ(state_of(stops).nodes[i].position, state_of(dissipates).nodes[i].position);
}

TEST(Recovery, IsRefusedWhereStatesDoNotFit) {
  for (const char* scheme : {"m1", "std", "newmark", "hht3", "edmc2"}) {
    scene::SceneDescription scene = stiff_cantilever(1, 0.01);
    scene.integrator.scheme = scheme;
    scene.integrator.on_failure = OnFailure::Dissipate;
    EXPECT_THROW(Simulation{scene}, ModelError) << scheme;
  }
}

/// A rotor that turns too far in a step until its damper has slowed it down.
scene::SceneDescription fast_rotor() {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1}).damping = 0.3;
  b.scene.initial_joints.push_back({"shaft", 0, 45, {}});
  b.scene.integrator.step = 0.1;
  return b.scene;
}

TEST(Recovery, HalvingsAreCountedAndNamed) {
  Simulation simulation(fast_rotor());
  const StepResult result = simulation.step();
  ASSERT_TRUE(result.converged);
  // The rotor turns by 4.5 rad in a step, and a sub-step may turn by 2 (tangent-scaled). So the step is halved three
  // times, or twice if the damper has slowed the rotor down by then.
  EXPECT_GE(result.deepest_halving, 2);
  EXPECT_LE(result.deepest_halving, 3);
  StepCounts counts;
  counts.add(result);
  EXPECT_EQ(recoveries_text(counts), std::to_string(result.halvings) + " halvings (down to 1/" +
                                         std::to_string(1 << result.deepest_halving) + " of a step)");
  EXPECT_EQ(recoveries_text(StepCounts()), "");
  counts = {};
  counts.deepest_halving = 40;  // as deep as at a stop
  EXPECT_EQ(recoveries_text(counts), "0 halvings (down to 1/1099511627776 of a step)");
}

// A friction law that changes steeply within a step's motion makes Newton's updates jump back and forth. Damped updates
// converge.
TEST(Recovery, NoStepIsHalvedForSteepFriction) {
  for (const char* scheme : {"em", "em0", "em_symmetric", "m1", "std"}) {
    Simulation simulation(everything_scene().scene, options(scheme));
    const Outcome out = outcome_of(simulation, 80);
    EXPECT_TRUE(out.converged) << scheme;
    EXPECT_EQ(out.counts.halvings, 0) << scheme;
    std::printf("%s: %ld halvings, %ld from other guesses\n", scheme, out.counts.halvings, out.counts.other_guesses);
  }
}

TEST(Recovery, WhatTheClockOnTheWallHasCutIsNotDoneAgain) {
  scene::SceneDescription scene = fast_rotor();
  scene.integrator.on_failure = OnFailure::Dissipate;
  SimulationOptions options;
  options.recovery_wall_time = 1e-9;
  Simulation simulation(scene, options);
  const StepResult result = simulation.step();
  EXPECT_EQ(result.reason, Reason::OutOfTime);
  EXPECT_FALSE(result.failure.tried_dissipation);
  EXPECT_FALSE(result.is_dissipated);
}

TEST(Recovery, TheSubstituteHasWhatIsLeftOfTheTime) {
  const Simulation simulation(fast_rotor());
  StepSettings settings;
  settings.step = simulation.step_size();
  settings.recovery_wall_time = 3600;
  DissipativeSubstitute substitute(model_of(simulation), make_scheme(simulation.scene().integrator), settings);
  State state = state_of(simulation);
  substitute.keep(state);
  StepResult result;
  EXPECT_FALSE(substitute.advance(state, Deadline(1e-9), result)) << "an hour of its own";
  EXPECT_EQ(state.time, 0);
  EXPECT_TRUE(substitute.advance(state, Deadline(3600), result));
  EXPECT_EQ(state.time, settings.step);
}

TEST(Recovery, EndsByTheClockOnTheWallAndGoesOn) {
  SimulationOptions options;
  options.recovery_wall_time = 1e-9;  // has always passed when it is checked
  Simulation simulation(fast_rotor(), options);
  int given_up = 0;
  double last = 0;
  while (simulation.time() < 1) {
    const StepResult result = simulation.step();
    if (!result.converged) {
      ASSERT_EQ(result.reason, Reason::OutOfTime);
      EXPECT_NE(simulation.explain(result).find("limit of wall time"), std::string::npos);
      ASSERT_LT(++given_up, 100);
    }
    EXPECT_GE(simulation.time(), last);
    last = simulation.time();
  }
  EXPECT_GT(given_up, 0);
}

}  // namespace
}  // namespace flexarm::test
