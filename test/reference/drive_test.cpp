// Tests drives against closed forms: rotors, elastic gears with backlash, losses, and limits of motors.
#include "math/dense_eigenpairs.h"
#include "math/pi.h"
#include "reference/one_coordinate_scenes.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

// The rotor adds gear^2 times its inertia to the joint. So the block moves as a heavier one.
TEST(Drive, RotorAddsItsReflectedInertia) {
  for (const char* scheme : {"em", "em4", "edmc2", "m1", "m2", "std", "newmark", "hht1", "hht2", "hht3"}) {
    SceneBuilder b = block_on_rail(0, 0.5), heavy = block_on_rail(0, 0.5);
    b.drive("rail", 50, 4e-4);
    heavy.scene.links.back().inertial->mass += 2500 * 4e-4;
    Simulation simulation(b.scene, options(scheme, 0.01)), expected(heavy.scene, options(scheme, 0.01));
    for (Simulation* s : {&simulation, &expected}) {
      s->command_effort(0, 6);
      run(*s, 100);
    }
    EXPECT_NEAR(simulation.position(0), expected.position(0), 1e-9) << scheme;
    EXPECT_NEAR(simulation.velocity(0), expected.velocity(0), 1e-9) << scheme;
    EXPECT_NEAR(simulation.energies().kinetic, expected.energies().kinetic, 1e-9) << scheme;
    EXPECT_NEAR(simulation.energies().work, expected.energies().work, 1e-9) << scheme;
  }
  SceneBuilder b = wheel_on_shaft(0);
  b.drive("shaft", 100, 2e-5);
  Simulation simulation(b.scene, options("em", 1e-4));
  simulation.command_effort(0, 1);
  run(simulation, 1000);
  // The wheel's own increments are tangent-scaled: a second-order error of 1e-5 rad per step.
  EXPECT_NEAR(simulation.velocity(0), 0.1 / (kWheelInertia + 0.2), 1e-9);
}

// A joint that moves no inertia except its rotor is accepted.
TEST(Drive, RotorIsEnoughToMove) {
  SceneBuilder b;
  b.body("nothing", 0, Vector3::Zero(), Matrix3::Zero());
  b.joint("shaft", JointKind::Revolute, "world", "nothing", {0, 0, 0}, {0, 0, 1});
  EXPECT_THROW(Simulation(b.scene), ModelError);
  b.drive("shaft", 10, 1e-3);
  Simulation simulation(b.scene, options("em", 1e-3));
  simulation.command_effort(0, 0.3);
  run(simulation, 1000);
  EXPECT_NEAR(simulation.velocity(0), 0.3 / 0.1, 1e-5) << "published rates are those of tangent-scaled increments";
}

/// Frequencies and mode shapes {1, s} of a mass on a spring, with a rotor behind an elastic gear.
struct TwoMasses {
  double mass, rotor, gear, spring;
  double square(int mode) const {  // omega^2
    const double a = (spring + gear) / mass, d = gear / rotor, c = gear / std::sqrt(mass * rotor);
    return 0.5 * (a + d) + (mode == 0 ? -1 : 1) * std::sqrt(0.25 * (a - d) * (a - d) + c * c);
  }
  double shape(int mode) const { return gear / (gear - rotor * square(mode)); }  // of the rotor
  double modal_part(int mode) const {                                            // of the initial displacement {1, 1}
    const double s = shape(mode);
    return (mass + rotor * s) / (mass + rotor * s * s);
  }
};

// The midpoint rule changes only the frequency of each mode of a linear system, to 2/h atan(omega h / 2).
TEST(Drive, ElasticGearHasTheFrequenciesOfTwoMasses) {
  const TwoMasses system{kBlockMass, 0.5, 800, 300};
  const double h = 0.01, start = 0.05;
  SceneBuilder b = block_on_rail(start, 0);
  b.drive("rail", 10, system.rotor / 100).stiffness = system.gear;
  b.scene.springs.push_back({"rail", system.spring, 0, {}});
  for (const std::string scheme : {"em", "newmark"}) {
    Simulation simulation(b.scene, options(scheme, h, 1e-13));
    double largest = 0;
    int n = 0;
    run(simulation, 2000, [&] {
      double expected = 0;
      ++n;
      for (const int mode : {0, 1}) {
        const double phase = 2 * std::atan(0.5 * h * std::sqrt(system.square(mode)));
        expected += start * system.modal_part(mode) * std::cos(n * phase);
      }
      largest = std::max(largest, std::abs(simulation.position(0) - expected));
    });
    // The phase after 2000 steps is 200 to 1000 rad, so frequencies agree at least to 1e-8. Newmark's rule begins with
    // accelerations from a difference, which is less accurate.
    EXPECT_LT(largest, (scheme == "em" ? 1e-8 : 1e-6) * start) << scheme;
    EXPECT_NEAR(simulation.degrees_of_freedom(), 1, 0) << "the rotor is no unknown of the step";
  }
}

// In the Hilber-Hughes-Taylor family, accelerations belong to another instant than the balance of a joint. The result
// is of second order all the same.
TEST(Drive, ElasticGearIsOfSecondOrderInAllFamilies) {
  const TwoMasses system{kBlockMass, 0.5, 800, 300};
  SceneBuilder b = block_on_rail(0.05, 0);
  b.drive("rail", 10, system.rotor / 100).stiffness = system.gear;
  b.scene.springs.push_back({"rail", system.spring, 0, {}});
  double exact = 0;
  for (const int mode : {0, 1})
    exact += 0.05 * system.modal_part(mode) * std::cos(0.5 * std::sqrt(system.square(mode)));
  for (const char* scheme : {"em", "m1", "edmc2", "newmark", "hht1", "hht2", "hht3"}) {
    double error[2];
    for (const int k : {0, 1}) {
      const int steps = 800 << k;
      Simulation simulation(b.scene, options(scheme, 0.5 / steps, 1e-13));
      run(simulation, steps);
      error[k] = std::abs(simulation.position(0) - exact);
    }
    EXPECT_LT(error[1], 1e-5) << scheme;
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2) << scheme;
  }
}

// The gear enters and leaves its play at any instant within a step. The energy account stays exact.
TEST(Drive, EnergyAccountThroughAThousandPassagesOfABacklash) {
  for (const double damping : {0.0, 0.02}) {
    SceneBuilder b = block_on_rail(0, 0.3);
    scene::DriveDescription& drive = b.drive("rail", 10, 5e-3);
    drive.stiffness = 4000;
    drive.backlash = 0.002;
    drive.damping = damping;
    b.scene.springs.push_back({"rail", 200, 0.01, {}});
    b.scene.efforts.push_back({"rail", TimeFunction::parse("3*sin(40*t)"), {}});
    Simulation simulation(b.scene, full_newton(options("em", 1e-3, 1e-13)));  // leaves no error of Newton's method
    InvariantDrift drift(simulation);
    double side = 0;
    int passages = 0;
    for (int n = 0; n < 200000 && passages < 1000; ++n) {
      ASSERT_TRUE(simulation.step().converged);
      const double twist = state_of(simulation).actuators[0].angle - simulation.position(0);
      if (std::abs(twist) > 0.001 && twist * side <= 0) {
        passages += side != 0;
        side = twist;
      }
      drift.observe();
    }
    EXPECT_EQ(passages, 1000);
    EXPECT_LT(drift.energy(), 1e-10);
  }
}

// The motor's line acts as a damper: v' = (L/m) (1 - v/V).
TEST(Drive, RunsUpToItsNoLoadSpeed) {
  const double limit = 5, speed = 2;
  double error[2];
  for (const int k : {0, 1}) {
    SceneBuilder b = block_on_rail(0, 0);
    scene::DriveDescription& drive = b.drive("rail", 1, 0);
    drive.effort_limit = limit;
    drive.velocity_limit = speed;
    Simulation simulation(b.scene, full_newton(options("em", 0.01 / (1 + k), 1e-12)));
    simulation.command_effort(0, 100);
    run(simulation, 1);
    EXPECT_NEAR(simulation.effort(0), limit, 0.1) << "stalls at its limit";
    run(simulation, (100 << k) - 1);
    error[k] = std::abs(simulation.velocity(0) - speed * (1 - std::exp(-limit / (kBlockMass * speed))));
    EXPECT_NEAR(energy_account(simulation), 0, 1e-10);
    run(simulation, 4000);
    EXPECT_NEAR(simulation.velocity(0), speed, 1e-6);
    EXPECT_NEAR(simulation.effort(0), 0, 1e-6);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2);
  // Against a load, the steady speed is that at which the motor's line gives the load.
  SceneBuilder b = block_on_rail(0, 0);
  scene::DriveDescription& drive = b.drive("rail", 10, 2e-3);
  drive.stiffness = 2000;
  drive.damping = 2;
  drive.effort_limit = limit;
  drive.velocity_limit = speed;
  b.load("block", Vector3::Zero(), {-3, 0, 0});
  Simulation simulation(b.scene, options("em", 1e-3));
  simulation.command_effort(0, 100);
  run(simulation, 12000);
  EXPECT_NEAR(simulation.effort(0), 3, 1e-4);
  EXPECT_NEAR(simulation.velocity(0), speed * (1 - 3 / limit), 1e-4);
}

// If the motor drives the load, the fraction `efficiency` of its effort arrives. If the load drives the motor, the
// fraction 2 - 1/efficiency of the load's effort arrives.
TEST(Drive, LosesByItsEfficiency) {
  for (const bool is_elastic : {false, true}) {
    const double rotor = 0.5, efficiency = 0.8;
    SceneBuilder b = block_on_rail(0, 1);
    scene::DriveDescription& drive = b.drive("rail", 10, rotor / 100);
    drive.efficiency = efficiency;
    if (is_elastic) drive.stiffness = 1e6, drive.damping = 500;
    Simulation simulation(b.scene, options("em", 1e-3, 1e-12));
    simulation.command_effort(0, 4);
    const double begin = energy_account(simulation);
    run(simulation, 1000);
    const double driving = 4 * efficiency / (kBlockMass + rotor * efficiency);
    EXPECT_NEAR(simulation.velocity(0), 1 + driving, is_elastic ? 1e-3 : 1e-6);
    EXPECT_NEAR(energy_account(simulation), begin, 1e-9);
    b.load("block", Vector3::Zero(), {3, 0, 0});
    Simulation driven(b.scene, options("em", 1e-3, 1e-12));
    run(driven, 1000);
    const double back = 1 / (2 - 1 / efficiency);  // the rotor's resistance is larger by this factor
    EXPECT_NEAR(driven.velocity(0), 1 + 3 / (kBlockMass + rotor * back), is_elastic ? 1e-3 : 1e-6);
  }
}

// Friction of the motor, on the rotor's side of the gear, follows the joint's friction law.
TEST(Drive, RotorSticks) {
  SceneBuilder b = block_on_rail(0, 0);
  b.scene.joints[0].friction_law.law = scene::FrictionDescription::Law::Coulomb;
  scene::DriveDescription& drive = b.drive("rail", 10, 5e-3);
  drive.stiffness = 100;
  drive.friction = 2;
  b.load("block", Vector3::Zero(), {0.9, 0, 0});
  Simulation simulation(b.scene, options("em", 1e-3, 1e-12));
  const double h = 1e-3, omega = 2 / h * std::atan(0.5 * h * std::sqrt(100 / kBlockMass));
  double largest = 0;
  int n = 0;
  run(simulation, 3000, [&] {
    EXPECT_EQ(state_of(simulation).actuators[0].angle, 0) << "the spring's 0.9 (1 - cos) stays below 2";
    const double expected = 0.009 * (1 - std::cos(omega * h * ++n));
    largest = std::max(largest, std::abs(simulation.position(0) - expected));
  });
  EXPECT_LT(largest, 1e-9);
  simulation.command_effort(0, 5);
  const double begin = energy_account(simulation);
  run(simulation, 2000);
  EXPECT_GT(state_of(simulation).actuators[0].angle, 0.1);
  EXPECT_NEAR(energy_account(simulation), begin, 1e-9 * simulation.energies().dissipated);
}

// The energy account of a flexible arm on an elastic gear closes.
TEST(Drive, FlexibleArmKeepsItsAccount) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.beam("arm", {{1, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 20, 25, 30, 0.5, 0.02, 0.01, 0.01}, 2, 2);
  b.joint("shoulder", JointKind::Revolute, "world", "arm", {0, 0, 0}, {0, 1, 0});
  scene::DriveDescription& drive = b.drive("shoulder", 100, 2e-5);
  drive.stiffness = 500;
  drive.damping = 0.5;
  drive.backlash = 1e-3;
  drive.friction = 0.2;
  drive.efficiency = 0.85;
  b.scene.springs.push_back({"shoulder", 3, -0.5, {}});
  b.scene.efforts.push_back({"shoulder", TimeFunction::parse("-2+3*sin(8*t)"), {}});
  Simulation simulation(b.scene, options("em", 1e-3, 1e-11));
  InvariantDrift drift(simulation);
  run(simulation, 2000, [&] { drift.observe(); });
  EXPECT_LT(drift.energy(), 1e-9);
  EXPECT_GT(simulation.energies().dissipated, 0.1);
}

// For a given motor effort, an elastic gear is deformed, but the equilibrium does not change.
TEST(Drive, StaticsOfSpringAndGear) {
  SceneBuilder b = block_on_rail(0, 0);
  b.scene.initial_joints.clear();
  scene::DriveDescription& drive = b.drive("rail", 10, 5e-3);
  drive.stiffness = 50;
  b.scene.springs.push_back({"rail", 40, 0.1, {}});
  b.scene.efforts.push_back({"rail", TimeFunction(2.0), {}});
  b.load("block", Vector3::Zero(), {6, 0, 0});
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(2).converged);
  EXPECT_NEAR(simulation.position(0), 0.1 + (6 + 2) / 40.0, 1e-12);
  EXPECT_NEAR(state_of(simulation).actuators[0].angle, simulation.position(0) + 2 / 50.0, 1e-12);
  run(simulation, 10);
  EXPECT_NEAR(simulation.position(0), 0.3, 1e-12) << "and stays there";
}

double angular_frequency(const Mode& mode) {
  return 2 * kPi * mode.frequency;
}

// Modes contain the inertia of the rotor, although the equilibrium does not depend on it.
TEST(Drive, ModesOfTwoMasses) {
  const TwoMasses system{kBlockMass, 0.5, 800, 300};
  SceneBuilder b = block_on_rail(0, 0);
  scene::DriveDescription& drive = b.drive("rail", 10, system.rotor / 100);
  b.scene.springs.push_back({"rail", system.spring, 0, {}});
  std::vector<Mode> modes = Simulation(b.scene).natural_modes(4);
  ASSERT_EQ(modes.size(), 1u) << "a rigid gear";
  EXPECT_NEAR(angular_frequency(modes[0]), std::sqrt(300 / (kBlockMass + 0.5)), 1e-10);
  drive.stiffness = system.gear;
  modes = Simulation(b.scene).natural_modes(4);
  ASSERT_EQ(modes.size(), 2u);
  for (const int mode : {0, 1}) {
    EXPECT_NEAR(angular_frequency(modes[mode]), std::sqrt(system.square(mode)), 1e-8 * std::sqrt(system.square(mode)));
    EXPECT_TRUE(modes[mode].rate == 0);
  }
  // With a servo on the motor instead of the spring, and with the servo's damping.
  b.scene.springs.clear();
  b.servo("rail", 500, 20);
  modes = Simulation(b.scene).natural_modes(4);
  Eigen::Matrix4d matrix;
  const double gear = system.gear, rotor = system.rotor;
  matrix << 0, 0, 1, 0, 0, 0, 0, 1, -gear / kBlockMass, gear / kBlockMass, 0, 0, gear / rotor, -(gear + 500) / rotor, 0,
      -20 / rotor;
  const Eigen::Vector4cd exact = dense_eigenpairs(matrix).values;
  ASSERT_EQ(modes.size(), 2u);
  for (const Mode& mode : modes) {
    const std::complex<double> found(mode.rate, angular_frequency(mode));
    EXPECT_LT((exact.array() - found).abs().minCoeff(), 1e-8 * std::abs(found));
  }
}

}  // namespace
}  // namespace flexarm::test
