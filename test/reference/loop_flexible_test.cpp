// Tests loops with a flexible link, closed by master and slave: invariants, closed forms, and equal motion of a
// mechanism that is cut at different joints.
#include <cmath>

#include "math/pi.h"
#include "reference/dynamics_runs.h"
#include "support/loops.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

scene::DirectSection soft() {
  return section(2e4, 1e4, 150, 200, 0.5, 0.02, 0.01);
}

enum class Cut { Ground, GroundFromRocker, Coupler };

/// A flexible crank, a coupler with a body beside it, and a flexible rocker, in the x-z plane, driven by their weight.
SceneBuilder four_bar(Cut cut) {
  SceneBuilder b;
  b.scene.gravity = {1, 0, -9.81};
  b.beam("crank", {{0.1, 0, 0.4}}, soft(), 2, 2);
  b.beam("coupler", {{1, 0, 0.2}}, soft(), 2, 2);
  const Vector3 rocker(0.2, 0, -0.7), hip(1.1, 0, 0.6);
  b.beam("rocker", {cut == Cut::Coupler ? Vector3(-rocker) : rocker}, soft(), 2, 2);
  b.body("body", 0.5, {0.05, 0.1, 0.1}, Vector3(0.02, 0.01, 0.015).asDiagonal());
  b.joint("ground", JointKind::Continuous, "world", "crank", {0, 0, 0}, kAcross);
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0.1, 0, 0.4}, kAcross);
  b.joint("glue", JointKind::Fixed, "coupler", "body", {0.5, 0, 0.1});
  if (cut == Cut::Coupler) {
    b.joint("foot", JointKind::Continuous, "world", "rocker", hip + rocker, kAcross);
    close_loop(b, "hip", JointKind::Continuous, "coupler", "rocker", -rocker, kAcross);
  } else {
    b.joint("hip", JointKind::Continuous, "coupler", "rocker", {1, 0, 0.2}, kAcross);
    close_loop(b, "foot", JointKind::Continuous, "world", "rocker", rocker, kAcross);
    if (cut == Cut::GroundFromRocker) {  // the same joint with parent and child exchanged
      scene::JointDescription& foot = b.scene.loop_joints.back();
      std::swap(foot.parent, foot.child);
      std::swap(foot.origin, foot.child_origin);
    }
  }
  return b;
}

TEST(FlexibleLoop, FourBarKeepsItsEnergyOverLargeSteps) {
  for (const Cut cut : {Cut::Ground, Cut::GroundFromRocker, Cut::Coupler})
    for (const char* scheme : {"em", "std", "edmc2", "beta2_repaired"}) {
      Simulation simulation(four_bar(cut).scene, options(scheme, 0.02, 1e-11));
      InvariantDrift drift(simulation);
      run(simulation, 40, [&] { drift.observe(); });
      EXPECT_LT(drift.energy(), 1e-12) << scheme;
      EXPECT_GT(std::abs(simulation.position(0)), 1);
    }
}

// The joint at which the loop is cut does not change the motion, except for the sign of a coordinate whose links are
// exchanged.
TEST(FlexibleLoop, FourBarMovesTheSameWhereverItIsCut) {
  for (const char* scheme : {"em", "m1", "newmark", "hht3"}) {
    std::vector<Simulation> simulations;
    for (const Cut cut : {Cut::Ground, Cut::GroundFromRocker, Cut::Coupler})
      simulations.emplace_back(four_bar(cut).scene, options(scheme, 0.005, 1e-12));
    const auto value = [](const Simulation& s, const char* name) { return s.position(*s.find_coordinate(name)); };
    for (int n = 0; n < 60; ++n)
      for (Simulation& simulation : simulations) ASSERT_TRUE(simulation.step().converged) << scheme;
    EXPECT_GT(std::abs(value(simulations[0], "foot")), 0.05);
    // In conserving schemes the maps of a step are exact. The averages in them differ between cuts.
    for (const char* name : {"ground", "knee", "hip", "foot"}) {
      const double expected = value(simulations[0], name);
      const double sign = std::string(name) == "foot" ? -1 : 1;
      EXPECT_NEAR(sign * value(simulations[1], name), expected, 1e-9) << scheme << " " << name;
      EXPECT_NEAR(value(simulations[2], name), expected, 1e-9) << scheme << " " << name;
    }
  }
}

TEST(FlexibleLoop, WorkOfADriveAccountsForTheEnergy) {
  for (const char* driven : {"ground", "knee", "foot"}) {
    SceneBuilder b = four_bar(Cut::Ground);
    b.scene.motions.push_back({driven, TimeFunction::parse("0.6*(1-cos(3*t))"), {}});
    Simulation simulation(b.scene, options("em", 0.02, 1e-11));
    InvariantDrift drift(simulation);
    run(simulation, 40, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), 1e-12) << driven;
    EXPECT_GT(std::abs(simulation.energies().work), 0.1) << driven;
  }
}

TEST(FlexibleLoop, EffortFrictionAndStopsActOnTheClosingJoint) {
  SceneBuilder b = four_bar(Cut::Ground);
  scene::JointDescription& foot = b.scene.loop_joints.back();
  foot.damping = 0.2;
  foot.friction = 0.1;
  foot.limits = scene::JointLimits{-0.2, 0.2};
  b.scene.contact_time = 10 * 0.01;
  b.scene.efforts.push_back({"foot", TimeFunction(3), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-11));
  InvariantDrift drift(simulation);
  double most = 0, speed = 0;
  const std::size_t index = *simulation.find_coordinate("foot");
  run(simulation, 300, [&] {
    drift.observe();
    most = std::max(most, std::abs(simulation.position(index)));
    speed = std::max(speed, std::abs(simulation.velocity(index)));
  });
  EXPECT_LT(drift.energy(), 1e-11);
  EXPECT_GT(most, 0.2);
  // The stop's stiffness is such that half a period of contact lasts ten steps, with all links that it stops.
  EXPECT_LT(most, 0.2 + speed * 10 * 0.01 / kPi) << "the stop must hold";
  EXPECT_GT(simulation.energies().dissipated, 0.1);
}

// ---------------------------------------------------------------- free flight

/// A floating body with two beams. A joint connects the tip of one beam to a body that rotates on the tip of the other
/// beam.
SceneBuilder free_loop(JointKind kind, bool reversed) {
  SceneBuilder b;
  b.body("trunk", 1, {0.1, 0, 0.05}, Vector3(0.05, 0.06, 0.07).asDiagonal());
  b.beam("left", {{0.6, 0.3, 0}, {0.9, 0, 0.1}}, soft(), 2, 2);
  b.beam("right", {{0.5, -0.4, 0.1}}, soft(), 2, 3);
  b.body("hand", 0.4, {0.05, 0.02, 0}, Vector3(0.004, 0.006, 0.005).asDiagonal());
  b.joint("flight", JointKind::Floating, "world", "trunk");
  b.joint("left", JointKind::Fixed, "trunk", "left");
  b.joint("right", JointKind::Revolute, "trunk", "right", {0, -0.1, 0}, {0.6, 0, 0.8});
  b.joint("hand", JointKind::Revolute, "right", "hand", {0.5, -0.4, 0.1}, {0, 0.6, 0.8});
  scene::JointDescription& loop = close_loop(b, "loop", kind, "hand", "left", {0.9, 0, 0.1}, {0.48, 0.6, 0.64});
  loop.axis2 = Vector3::UnitX();
  loop.ratio = 0.3;
  if (reversed) {
    std::swap(loop.parent, loop.child);
    std::swap(loop.origin, loop.child_origin);
  }
  initial_field(b, "trunk", {0.02, -0.01, 0.03}, {2, -3, 4});
  return b;
}

class FreeLoop : public ::testing::TestWithParam<std::tuple<JointKind, bool>> {};

TEST_P(FreeLoop, ConservesEnergyAndMomenta) {
  const auto [kind, reversed] = GetParam();
  if (reversed && kind == JointKind::Spherical) {
    EXPECT_THROW(Simulation(free_loop(kind, true).scene), ModelError);
    return;
  }
  SceneBuilder b = free_loop(kind, reversed);
  set_drift(b, Vector3::Zero());
  for (const char* scheme : {"em", "std", "m1"}) {
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-11));
    InvariantDrift drift(simulation);
    run(simulation, 100, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), std::string(scheme) == "m1" ? 1 : 1e-11) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, FreeLoop,
                         ::testing::Combine(::testing::Values(JointKind::Fixed, JointKind::Revolute,
                                                              JointKind::Prismatic, JointKind::Spherical,
                                                              JointKind::Universal, JointKind::Cylindrical,
                                                              JointKind::PinSlot, JointKind::Planar, JointKind::Screw),
                                            ::testing::Bool()));

/// A flying beam whose end is welded to its beginning, if `gap` [m] is 0.
SceneBuilder closed_ring(double gap) {
  SceneBuilder b;
  b.beam("ring", {{0.5, 0, 0}, {0.5, 0.5, 0.2}, {0, 0.5, 0.2}, {0, gap, 0}}, soft(), 8, 2);
  b.joint("flight", JointKind::Floating, "world", "ring");
  scene::JointDescription weld;
  weld.name = "weld";
  weld.parent = weld.child = "ring";
  b.scene.loop_joints.push_back(weld);
  initial_field(b, "ring", {0.02, -0.01, 0.03}, {2, -3, 4});
  return b;
}

TEST(FlexibleLoop, ClosedRingFliesWithItsMomenta) {
  SceneBuilder b = closed_ring(0);
  set_drift(b, Vector3::Zero());
  for (const char* scheme : {"em", "std"}) {
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-11));
    InvariantDrift drift(simulation);
    run(simulation, 100, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), 1e-11) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
    EXPECT_LT((simulation.tip_pose(1).position - simulation.link_pose(1).position).norm(), 1e-12) << scheme;
  }
}

TEST(FlexibleLoop, RingThatIsNotClosedIsRefused) {
  expect_contains(refusal_of(closed_ring(0.01).scene), "both places are the same section of link 'ring'");
}

// ---------------------------------------------------------------- statics and modes

enum class HeldEnds { Clamped, ClampedBeside, Hinged };

/// A beam of unit length along x, held at both ends.
SceneBuilder held_beam(HeldEnds ends, int elements) {
  SceneBuilder b;
  b.beam("beam", {{1, 0, 0}}, section(1e6, 4e5, 50, 100, 0.5, 1e-4, 5e-5), elements, 2);
  if (ends == HeldEnds::Hinged) {
    b.joint("near", JointKind::Universal, "world", "beam", {0, 0, 0}, {0, 1, 0}).axis2 = Vector3(0, 0, 1);
    close_loop(b, "far", JointKind::Spherical, "world", "beam", {1, 0, 0});
  } else if (ends == HeldEnds::Clamped) {
    b.joint("near", JointKind::Fixed, "world", "beam");
    close_loop(b, "far", JointKind::Fixed, "world", "beam", {1, 0, 0});
  } else {  // by a body that sticks out from the tip
    b.body("bracket", 0, Vector3::Zero(), Matrix3::Zero());
    b.joint("near", JointKind::Fixed, "world", "beam");
    b.joint("glue", JointKind::Fixed, "beam", "bracket", {1, 0, 0.2});
    close_loop(b, "far", JointKind::Fixed, "world", "bracket", {0.1, 0.3, 0});
  }
  return b;
}

// Bending and shear by a uniform load. It is so small that the beam's stretching has an effect below 1e-7.
TEST(FlexibleLoop, SagOfABeamHeldAtBothEnds) {
  const double load = 1e-3, ei = 100, ga = 4e5;
  for (const HeldEnds ends : {HeldEnds::Clamped, HeldEnds::ClampedBeside, HeldEnds::Hinged}) {
    const double expected = load / ei * (ends == HeldEnds::Hinged ? 5 : 1) / 384 + load / ga / 8;
    double error[3];
    for (int refinement = 0; refinement < 3; ++refinement) {
      SceneBuilder b = held_beam(ends, 2 << refinement);
      b.scene.distributed_loads.push_back({"beam", {0, 0, load}, scene::LoadFrame::World, TimeFunction(1), {}});
      b.probe("middle", "beam", {0.5, 0, 0});
      Simulation simulation(b.scene, options("newmark", 0.01, 1e-13));
      ASSERT_TRUE(simulation.solve_static(1).converged);
      error[refinement] = std::abs(simulation.probe(0).pose.position.z() / expected - 1);
    }
    // At the nodes, displacements of quadratic elements converge with fourth order.
    EXPECT_LT(error[1], 0.1 * error[0] + 1e-7);
    EXPECT_LT(error[2], 0.1 * error[1] + 1e-7);
    EXPECT_LT(error[2], 1e-3);
  }
}

// First frequency of a slender beam: 4.730041^2 or pi^2, times sqrt(EI / m L^4).
TEST(FlexibleLoop, FrequencyOfABeamHeldAtBothEnds) {
  for (const HeldEnds ends : {HeldEnds::Clamped, HeldEnds::ClampedBeside, HeldEnds::Hinged}) {
    const Simulation simulation(held_beam(ends, 16).scene);
    const double number = ends == HeldEnds::Hinged ? kPi : 4.730040744862704;
    const double expected = number * number * std::sqrt(100 / 0.5) / (2 * kPi);
    // Shear and rotary inertia lower the frequency by number^2 (EI / GA + J / m) times a factor of order one.
    EXPECT_NEAR(simulation.natural_modes(1)[0].frequency / expected, 1, 2 * number * number * (100 / 4e5 + 1e-4));
  }
}

}  // namespace
}  // namespace flexarm::test
