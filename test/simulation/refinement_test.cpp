// Tests elements that are halved while they are strongly bent, and joined again.
#include "simulation/refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "building/model_builder.h"
#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/model/model_error.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/linear_model.h"
#include "flexarm/simulation/payloads.h"
#include "integrators/energies.h"
#include "math/pi.h"
#include "simulation/mesh_change.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_builder.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A rod that flies and is bent by opposite moments at its ends for 0.05 s, by which it winds up; then it springs back.
SceneBuilder flying_rod(bool refine, const char* scheme = "em", const std::string& history = "t < 0.05 ? 1 : 0",
                        double damping = 0) {
  SceneBuilder b;
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = 1e-3;
  scene::BeamDescription& beam = b.beam("rod", {{1, 0, 0}}, section(1e5, 4e4, 0.08, 0.1, 0.1, 2e-6, 1e-6), 4, 2);
  beam.refine = refine;
  beam.stiffness_proportional_damping = damping;
  b.joint("free", JointKind::Floating, "world", "rod");
  b.scene.initial_links.push_back({"rod", {1, -0.5, 0.2}, {0.3, 0.5, -2}, {}});
  b.load("rod", {0, 0, 0}, Vector3::Zero(), {0.1, 0.2, -1}, history);
  b.load("rod", {1, 0, 0}, Vector3::Zero(), {-0.1, -0.2, 1}, history);
  return b;
}

std::size_t halvings(const Simulation& simulation) {
  return state_of(simulation).halved.size();
}

TEST(Refinement, MomentaAndAccountOfAWoundRodAreKept) {
  for (const char* scheme : {"em", "em_symmetric", "edmc2"}) {
    Simulation simulation(flying_rod(true, scheme).scene);
    const Vector3 linear = simulation.momentum(), angular = simulation.angular_momentum();
    const double account = energy_account(simulation);
    double largest_energy = 0;
    std::set<std::size_t> counts;
    for (int n = 0; n < 200; ++n) {
      const StepResult result = simulation.step();
      ASSERT_TRUE(result.converged) << scheme << ": " << simulation.explain(result);
      counts.insert(halvings(simulation));
      const Energies e = simulation.energies();
      largest_energy = std::max(largest_energy, e.kinetic + e.strain);
      // The tolerance of Newton's method leaves an error in each step.
      const double tolerance = 100 * simulation.tolerance();
      EXPECT_LE((simulation.momentum() - linear).norm(), tolerance * linear.norm()) << scheme << ", step " << n;
      EXPECT_LE((simulation.angular_momentum() - angular).norm(), tolerance * angular.norm()) << scheme << ", " << n;
      EXPECT_NEAR(energy_account(simulation), account, tolerance * largest_energy) << scheme << ", step " << n;
      if (::testing::Test::HasFailure()) break;
    }
    EXPECT_GT(*counts.rbegin(), 4u) << scheme;
  }
}

TEST(Refinement, HalvesAreJoinedWhenTheRodIsStraightAgain) {
  // Damping stretches the rod.
  Simulation simulation(flying_rod(true, "em", "t < 0.05 ? 1 : 0", 5e-2).scene);
  const Vector3 linear = simulation.momentum(), angular = simulation.angular_momentum();
  const double account = energy_account(simulation);
  std::size_t most = 0;
  for (int n = 0; n < 500; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    most = std::max(most, halvings(simulation));
  }
  EXPECT_GT(most, 4u);
  EXPECT_EQ(halvings(simulation), 0u);
  const double tolerance = 100 * simulation.tolerance();
  EXPECT_LE((simulation.momentum() - linear).norm(), tolerance * linear.norm());
  EXPECT_LE((simulation.angular_momentum() - angular).norm(), tolerance * angular.norm());
  EXPECT_NEAR(energy_account(simulation), account, tolerance * simulation.energies().work);
}

/// The state with elements halved as in `halved`.
State changed(const Simulation& simulation, const std::vector<HalvedElement>& halved, Model& after) {
  scene::SceneDescription scene = simulation.scene();
  set_halved(halved, scene);
  after = build_model(scene);
  return on_changed_mesh(model_of(simulation), state_of(simulation), after, scheme_of(simulation));
}

TEST(Refinement, HalvingAndJoiningKeepMomentaUpToRoundOff) {
  // Elements are bent by up to about a radian.
  Simulation simulation(flying_rod(false, "em", "t < 0.05 ? 0.4 : 0").scene);
  run(simulation, 10);
  const std::vector<HalvedElement> some = {{1, 0, 1}, {1, 1, 1}, {1, 3, 1}};
  Model fine;
  const State halved = changed(simulation, some, fine);
  const State joined = on_changed_mesh(fine, halved, model_of(simulation), scheme_of(simulation));
  const Scheme& scheme = scheme_of(simulation);
  const Momenta before = momenta(model_of(simulation), scheme, state_of(simulation));
  const Energies first = energies(model_of(simulation), scheme, state_of(simulation));
  for (const auto& [model, state] : {std::pair(&std::as_const(fine), &halved), {&model_of(simulation), &joined}}) {
    const Momenta after = momenta(*model, scheme, *state);
    EXPECT_LE((after.linear - before.linear).norm(), 1e-14 * before.linear.norm());
    EXPECT_LE((after.angular - before.angular).norm(), 1e-13 * before.angular.norm());
    const Energies e = energies(*model, scheme, *state);
    EXPECT_NEAR(e.total() - e.work + e.dissipated, first.total() - first.work + first.dissipated, 1e-14 * e.total());
    // The energies are those of a slightly different curve.
    EXPECT_NEAR(e.total(), first.total(), 1e-2 * first.total());
  }
  for (const auto& element : std::get<BeamGroup<3>>(model_of(simulation).beams).elements)
    for (const int end : {element.nodes[0], element.nodes[2]})
      EXPECT_EQ(joined.nodes[end].position, state_of(simulation).nodes[end].position);
}

TEST(Refinement, RunsWithoutStrongBendingHaveTheSameBits) {
  Simulation plain(flying_rod(false, "em", "t < 0.005 ? 0.1 : 0").scene);
  Simulation refining(flying_rod(true, "em", "t < 0.005 ? 0.1 : 0").scene);
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(plain.step().converged);
    ASSERT_TRUE(refining.step().converged);
    for (std::size_t i = 0; i < state_of(plain).nodes.size(); ++i) {
      ASSERT_EQ(state_of(plain).nodes[i].position, state_of(refining).nodes[i].position);
      ASSERT_EQ(state_of(plain).nodes[i].velocity, state_of(refining).nodes[i].velocity);
    }
  }
  EXPECT_EQ(halvings(refining), 0u);
}

/// Two elements, slowly bent by a moment at the tip to four and a half turns. Damping keeps it at rest: wound up as far
/// as that, it would buckle and swing.
SceneBuilder wound_beam(bool refine) {
  SceneBuilder b;
  scene::BeamDescription& beam = b.beam("arm", {{1, 0, 0}}, section(1e5, 3.5e4, 0.8, 1, 1, 2e-5, 1e-5), 2, 2);
  beam.refine = refine;
  beam.stiffness_proportional_damping = 3e-3;
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, Vector3::Zero(), {0, 9 * kPi, 0}, "(1 - cos(_pi*min(t, 20)/20))/2");
  b.probe("tip", "arm", {1, 0, 0});
  b.scene.integrator.step = 0.02;
  return b;
}

TEST(Refinement, WoundBeamBecomesACircle) {
  Simulation simulation(wound_beam(true).scene);
  while (simulation.time() < 20 - 1e-9) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
  }
  // The curvature is that of the moment everywhere, so the tip has turned by 9 pi on a circle of radius 1 / (9 pi). The
  // bound on the turning of an element is for an error of 1 %.
  const Vector3 tip = simulation.probe(0).pose.position;
  EXPECT_LE((tip - Vector3(0, 0, -2 / (9 * kPi))).norm(), 0.01);
  // As many nodes are shown as the scene gives.
  std::vector<BeamPoint> points;
  simulation.beam_points(1, 0, points);
  ASSERT_EQ(points.size(), 5u);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(points[k].arc_length, 0.25 * k, 1e-14);
  EXPECT_NEAR(points[2].strain[4], 9 * kPi, 0.03 * 9 * kPi);
  EXPECT_EQ(simulation.undeformed_sections(1, 2).size(), 13u);
}

TEST(Refinement, RunGoesOnFromACheckpointWithTheSameBits) {
  const SimulationOptions options = full_newton();
  Simulation simulation(flying_rod(true).scene, options), other(flying_rod(true).scene, options);
  run(simulation, 60);
  ASSERT_GT(halvings(simulation), 0u);
  read_checkpoint_text(other, checkpoint_text(simulation), "saved");
  EXPECT_EQ(checkpoint_text(other), checkpoint_text(simulation));
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_TRUE(other.step().converged);
  }
  EXPECT_EQ(checkpoint_text(other), checkpoint_text(simulation));
  simulation.reset();
  EXPECT_EQ(halvings(simulation), 0u);
  EXPECT_EQ(checkpoint_text(simulation), checkpoint_text(Simulation(flying_rod(true).scene, options)));
}

TEST(Refinement, MirrorsShowStatesOfAnyMesh) {
  Simulation simulation(flying_rod(true).scene);
  Simulation mirror = simulation.copy();
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    mirror.restore(simulation.snapshot());
    EXPECT_EQ(mirror.energies().total(), simulation.energies().total());
    EXPECT_EQ(mirror.tip_pose(1).position, simulation.tip_pose(1).position);
  }
  EXPECT_GT(halvings(mirror), 0u);
}

TEST(Refinement, DamagedListsOfHalvedElementsAreRefused) {
  Simulation simulation(flying_rod(true).scene);
  run(simulation, 60);
  const Model& model = model_of(simulation);
  EXPECT_EQ(halving_flaw(model, model.halved), "");
  EXPECT_NE(halving_flaw(model, {{1, 0, 2}}), "");  // its parent is whole
  EXPECT_NE(halving_flaw(model, {{1, 4, 1}}), "");  // there are four elements
  EXPECT_NE(halving_flaw(model, {{0, 0, 1}}), "");  // the world is no beam
  EXPECT_NE(halving_flaw(model, {{1, 0, 1}, {1, 0, 1}}), "");
  Simulation plain(flying_rod(false).scene);
  EXPECT_THROW(restore(plain, state_of(simulation)), std::invalid_argument);
  EXPECT_TRUE(plain.step().converged);
}

TEST(Refinement, PayloadsComeAndGoOnHalvedElements) {
  SceneBuilder b = flying_rod(true);
  b.body("box", 0.05, {0, 0, 0}, 1e-5 * Matrix3::Identity());
  b.joint("box_free", JointKind::Floating, "world", "box");
  b.scene.initial_joints.push_back({"box_free/y", 3, 0, {}});
  Simulation simulation(b.scene);
  run(simulation, 60);
  const std::size_t count = halvings(simulation);
  ASSERT_GT(count, 0u);
  const Vector3 linear = simulation.momentum(), angular = simulation.angular_momentum();
  attach(simulation, "box", "rod");
  EXPECT_EQ(halvings(simulation), count);
  run(simulation, 10);
  detach(simulation, "box");
  run(simulation, 10);
  EXPECT_LE((simulation.momentum() - linear).norm(), 100 * simulation.tolerance() * linear.norm());
  EXPECT_LE((simulation.angular_momentum() - angular).norm(), 100 * simulation.tolerance() * angular.norm());
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  EXPECT_FALSE(linearise(simulation, request).states.empty());
}

/// Expects that the account of energies closes in 60 steps in which elements are halved, and that something dissipates
/// in each of them.
void expect_account_closes(const SceneBuilder& b) {
  Simulation simulation(b.scene);
  const double account = energy_account(simulation);
  double dissipated = 0, largest_energy = 0;
  for (int n = 0; n < 60; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
    const Energies e = simulation.energies();
    largest_energy = std::max(largest_energy, e.kinetic + e.strain);
    EXPECT_GT(e.dissipated, dissipated) << "step " << n;
    EXPECT_NEAR(energy_account(simulation), account, 100 * simulation.tolerance() * largest_energy) << "step " << n;
    dissipated = e.dissipated;
  }
  EXPECT_GT(halvings(simulation), 0u);
}

// Its force follows the mesh: each node has the length that belongs to it.
TEST(Refinement, DragActsOnHalves) {
  SceneBuilder b = flying_rod(true);
  b.scene.links.back().drag = scene::DragDescription{{0, 1, 1}, 1.2, Vector3(0, 0.05, 0.05)};
  expect_account_closes(b);
}

// The strains of the springs of Maxwell elements are carried over to the points of the halves.
TEST(Refinement, MaxwellElementsRelaxInHalves) {
  SceneBuilder b = flying_rod(true);
  b.scene.links.back().beam->maxwell = {{0.3, 0.01}, {0.1, 0.5}};
  expect_account_closes(b);
}

/// A bead that slides along a beam, which is bent far by a moment at its tip.
SceneBuilder bead_on_beam(int elements, bool refine, double step) {
  SceneBuilder b;
  b.beam("line", {{1, 0, 0}}, section(1e5, 4e4, 0.8, 1, 1, 2e-5, 1e-5), elements, 2).refine = refine;
  b.joint("clamp", JointKind::Fixed, "world", "line");
  b.body("bead", 0.2, {0, 0, 0}, 1e-5 * Matrix3::Identity());
  b.joint("ring", JointKind::Slide, "line", "bead").slide = scene::SlideDescription{0.1, JointKind::Fixed};
  b.scene.initial_joints.push_back({"ring", 0.1, 1.0, {}});
  b.load("line", {1, 0, 0}, Vector3::Zero(), {0, -5, 0}, "(1 - cos(_pi*min(t, 0.5)/0.5))/2");
  b.probe("bead", "bead", {0, 0, 0});
  b.scene.integrator.step = step;
  return b;
}

TEST(Refinement, SliderPassesOverBordersOfHalves) {
  const auto end_of = [](int elements, bool refine, double step) {
    Simulation simulation(bead_on_beam(elements, refine, step).scene);
    const double account = energy_account(simulation);
    while (simulation.time() < 0.6 - 1e-9) {
      const StepResult result = simulation.step();
      EXPECT_TRUE(result.converged) << simulation.explain(result);
      if (!result.converged) break;
      EXPECT_NEAR(energy_account(simulation), account, 1e-6);
    }
    EXPECT_EQ(halvings(simulation) > 0, refine);
    return simulation.probe(0).pose.position;
  };
  const Vector3 fine = end_of(16, false, 5e-4);
  const double of_steps = (end_of(16, false, 1e-3) - fine).norm(), of_halving = (end_of(4, true, 1e-3) - fine).norm();
  // Errors of the mesh are below 1 % of the length by the bound for halving.
  EXPECT_LE(of_halving, 4 * of_steps + 0.01);
}

TEST(Refinement, SlidersLeaveHalvedLines) {
  SceneBuilder b = bead_on_beam(4, true, 1e-3);
  b.scene.joints.back().slide->on_end = scene::SlideDescription::End::Free;
  b.scene.initial_joints.back().velocity = 2;
  Simulation simulation(b.scene);
  Simulation mirror = simulation.copy();
  const double account = energy_account(simulation);
  std::size_t when_left = 0;  // number of halvings
  for (int n = 0; n < 900; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
    if (when_left == 0 && !state_of(simulation).left_lines.empty()) when_left = halvings(simulation);
    EXPECT_NEAR(energy_account(simulation), account, 100 * simulation.tolerance() * simulation.energies().total());
  }
  EXPECT_GT(when_left, 0u);
  EXPECT_GT(halvings(simulation), when_left);
  mirror.restore(simulation.snapshot());
  EXPECT_EQ(mirror.link_pose(2).position, simulation.link_pose(2).position);
  simulation.reset();
  EXPECT_TRUE(simulation.step().converged);
}

TEST(Refinement, IsRefusedWhereItIsNotPossible) {
  for (const char* scheme : {"em", "em0", "em_symmetric", "em4", "edmc1", "edmc2"})
    EXPECT_EQ(refusal_of(flying_rod(true, scheme).scene), "") << scheme;
  for (const char* scheme : {"m1", "m2", "std", "beta1", "newmark", "hht3"})
    expect_contains(refusal_of(flying_rod(true, scheme).scene), "has no <beam refine=\"true\">");
  SceneBuilder closed = bead_on_beam(4, true, 1e-3);
  closed.body("bar", 0.1, {0, 0, 0}, 1e-5 * Matrix3::Identity());
  closed.joint("bar_free", JointKind::Floating, "world", "bar", {0.1, 0, 0});
  closed.scene.initial_links.push_back({"bar", {1, 0, 0}, Vector3::Zero(), {}});
  scene::JointDescription ball;
  ball.name = "ball";
  ball.kind = JointKind::Spherical;
  ball.parent = "bead";
  ball.child = "bar";
  closed.scene.loop_joints.push_back(ball);
  EXPECT_NE(refusal_of(closed.scene).find("expected refine=\"false\" in a scene with a <loop_joint>"),
            std::string::npos)
      << refusal_of(closed.scene);

  scene::SceneDescription wiper = scene_at("config/examples/wiper.urdf");
  for (scene::LinkDescription& link : wiper.links)
    if (link.beam) link.beam->refine = true;
  const std::string touching = refusal_of(wiper);
  EXPECT_NE(touching.find("wiper.urdf:"), std::string::npos) << touching;
  EXPECT_NE(touching.find("may touch something"), std::string::npos) << touching;

  Simulation simulation(flying_rod(true).scene);
  RunWatcher watcher;
  EXPECT_THROW(run_to_accuracy(simulation, {0.01, 0.1}, watcher), ModelError);
}

TEST(Refinement, LeftOpenIsTrueOnlyWhereItIsPossible) {
  const auto refined = [](scene::SceneDescription scene) {
    const Simulation simulation(scene);
    refine_where_possible(scheme_of(simulation), model_of(simulation), scene);
    std::vector<std::optional<bool>> out;
    for (const scene::LinkDescription& link : scene.links)
      if (link.beam) out.push_back(link.beam->refine);
    Simulation again(scene);  // does not refuse it
    return out;
  };
  using Refine = std::vector<std::optional<bool>>;
  const auto rod = [](const char* scheme, int order, int elements) {
    SceneBuilder b;
    b.scene.integrator.scheme = scheme;
    b.beam("rod", {{1, 0, 0}}, section(1e5, 4e4, 0.08, 0.1, 0.1, 2e-6, 1e-6), elements, order);
    b.joint("clamp", JointKind::Revolute, "world", "rod");
    return b.scene;
  };
  EXPECT_EQ(refined(rod("em", 2, 4)), Refine{true});
  EXPECT_EQ(refined(rod("em", 3, 4)), Refine{std::nullopt});
  EXPECT_EQ(refined(rod("em", 2, 0)), Refine{std::nullopt});
  EXPECT_EQ(refined(rod("m1", 2, 4)), Refine{std::nullopt});
  EXPECT_EQ(refined(flying_rod(false).scene), Refine{false});
  const scene::SceneDescription wiper = scene_at("config/examples/wiper.urdf");
  for (const std::optional<bool>& beam : refined(wiper)) EXPECT_FALSE(beam.has_value());
}

TEST(Refinement, LeftOpenIsFalseInSteps) {
  SceneBuilder open = flying_rod(false);
  open.scene.links.back().beam->refine = std::nullopt;
  Simulation simulation(open.scene), plain(flying_rod(false).scene);
  EXPECT_FALSE(refines(model_of(simulation)));
  for (int n = 0; n < 100; ++n) ASSERT_EQ(simulation.step().converged, plain.step().converged);
  EXPECT_EQ(checkpoint_text(simulation), checkpoint_text(plain));
  RunWatcher watcher;
  simulation.reset();
  EXPECT_NO_THROW(run_to_accuracy(simulation, {0.01, 0.01}, watcher));
}

}  // namespace
}  // namespace flexarm::test
