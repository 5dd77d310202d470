// Tests damping of single strains of a beam, and damping of joints by a damping ratio. (modes_wedge_test tests damping
// ratios of a beam's modes.)
#include <array>

#include "math/pi.h"
#include "reference/one_coordinate_scenes.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

// ---------------------------------------------------------------- strains

/// A clamped beam along x. Its strains have different frequencies.
SceneBuilder cantilever(const scene::DirectSection& section, double viscosity = 0,
                        const Vector6& shares = Vector6::Ones()) {
  SceneBuilder b;
  scene::BeamDescription& beam = b.beam("rod", {{1, 0, 0}}, section, 8, 3);
  beam.stiffness_proportional_damping = viscosity;
  beam.damping_shares = shares;
  b.joint("clamp", scene::JointKind::Fixed, "world", "rod");
  b.probe("tip", "rod", {1, 0, 0});
  return b;
}

/// A section that is rigid in shear to 1e-7 of the energy, with small rotary inertia.
constexpr scene::DirectSection kSlender{4e3, 1e8, 1e8, 6, 8, 12, 1, 0.01, 1e-7, 1e-7};
/// A section that is rigid in bending to 1e-7 of the energy.
constexpr scene::DirectSection kShearing{1e5, 8, 12, 1e3, 1e8, 1e8, 1, 0.01, 1e-3, 1e-3};

/// The slowest mode that moves the tip mainly in this component of {displacement, spin}. Bending rotates the tip as
/// well.
Mode slowest(const SceneBuilder& b, int component) {
  const Simulation simulation(b.scene);
  for (const Mode& mode : simulation.natural_modes(12)) {
    const ComplexVector6& tip = mode.node_motion.back();
    if (std::abs(tip[component]) > 0.5 * tip.cwiseAbs().maxCoeff()) return mode;
  }
  ADD_FAILURE() << "no mode of component " << component;
  return {};
}

// A mode with a single strain has the damping ratio eta omega / 2 of this strain. Damping of other strains has no
// effect on it.
TEST(DampingOfStrains, RatiosOfModes) {
  struct Case {
    Strain strain;
    const scene::DirectSection* section;
    int component;  // of {displacement, spin}
  };
  for (const Case& c : {Case{kAxial, &kSlender, 0}, Case{kShearY, &kShearing, 1}, Case{kShearZ, &kShearing, 2},
                        Case{kTorsion, &kSlender, 3}, Case{kBendingY, &kSlender, 2}, Case{kBendingZ, &kSlender, 1}}) {
    const double omega = 2 * kPi * slowest(cantilever(*c.section), c.component).frequency, ratio = 0.02;
    Vector6 shares = Vector6::Zero();
    shares[c.strain] = 1;
    const double eta = 2 * ratio / omega;
    EXPECT_NEAR(slowest(cantilever(*c.section, eta, shares), c.component).damping_ratio(), ratio, 1e-4 * ratio)
        << "strain " << c.strain;
    const Vector6 others = Vector6::Ones() - shares;
    EXPECT_LT(slowest(cantilever(*c.section, eta, others), c.component).damping_ratio(), 1e-4 * ratio)
        << "all but strain " << c.strain;
  }
}

/// Positions of the tip after the release from a load. The load's moment twists the beam as well.
std::vector<Vector3> released(const std::string& scheme, double viscosity, const Vector6& shares) {
  SceneBuilder b = cantilever(kSlender, viscosity, shares);
  b.load("rod", {1, 0, 0}, {0, 0.02, 0.03}, Vector3::Zero(), "t > 0 ? 0 : 1");
  Simulation simulation(b.scene, options(scheme, 2e-3, 1e-10));
  EXPECT_TRUE(simulation.solve_static(1).converged);
  std::vector<Vector3> tips;
  run(simulation, 300, [&] { tips.push_back(simulation.probe(0).pose.position); });
  return tips;
}

// In every family of schemes: bending about y is damped as if all strains were damped, bending about z not at all.
TEST(DampingOfStrains, ActsOnItsStrainAloneInEveryScheme) {
  Vector6 shares = Vector6::Zero();
  shares[kBendingY] = 1;
  for (const char* scheme : {"em", "em0", "edmc2", "em4", "m1", "std", "beta1", "newmark", "hht1", "hht3"}) {
    const std::vector<Vector3> one = released(scheme, 0.02, shares), all = released(scheme, 0.02, Vector6::Ones()),
                               none = released(scheme, 0, Vector6::Ones());
    const double deflection = 0.03 / (3 * 8);  // at the start; the planes are coupled by its square
    double damped = 0;
    for (std::size_t n = 0; n < one.size(); ++n) {
      ASSERT_NEAR(one[n].z(), all[n].z(), 1e-4 * deflection) << scheme << n;
      ASSERT_NEAR(one[n].y(), none[n].y(), 1e-4 * deflection) << scheme << n;
      damped = std::max(damped, std::abs(all[n].z() - none[n].z()));
    }
    EXPECT_GT(damped, 0.3 * deflection) << scheme;
  }
}

// With strong damping of one strain, the deflection creeps back without oscillation.
TEST(DampingOfStrains, StrongDampingCreeps) {
  Vector6 shares = Vector6::Zero();
  shares[kBendingY] = 1;
  const double eta = 10;  // [s]; omega is 10/s. So the fast root is 1000/s, and the slow one 1/eta to 1e-4
  for (const char* scheme : {"em", "edmc2"}) {
    const std::vector<Vector3> tips = released(scheme, eta, shares);
    for (std::size_t n = 1; n < tips.size(); ++n)
      ASSERT_LE(tips[n].z(), tips[n - 1].z() * (1 + 1e-9)) << scheme << " at step " << n;
    EXPECT_NEAR(tips.back().z() / tips.front().z(), std::exp(-2e-3 * (static_cast<double>(tips.size()) - 1) / eta),
                4e-4)
        << scheme;
  }
}

// ---------------------------------------------------------------- joints

TEST(DampingOfJoints, RatioOnASpring) {
  for (const double ratio : {0.01, 0.3}) {
    SceneBuilder b = wheel_on_shaft(1);
    b.scene.springs.push_back({"shaft", 40, 0, {}, ratio});
    const double omega = std::sqrt(40 / kWheelInertia), damped = omega * std::sqrt(1 - ratio * ratio);
    const std::vector<Mode> modes = Simulation(b.scene).natural_modes(1);
    EXPECT_NEAR(modes[0].damping_ratio(), ratio, 1e-4 * ratio);
    // Over one period. The phase error of a step is (omega h)^2 / 12 times the phase.
    const double period = 2 * kPi / damped;
    const int steps = 2000;
    Simulation simulation(b.scene, options("em", period / steps, 1e-12));
    run(simulation, steps);
    const double step_error = 2 * kPi * std::pow(2 * kPi / steps, 2) / 12;
    EXPECT_NEAR(simulation.velocity(0), std::exp(-ratio * omega * period), 4 * step_error) << ratio;
  }
}

/// Two links of length 1 in line, with a mass at the end of each, and hinges about z.
SceneBuilder two_links() {
  SceneBuilder b;
  b.body("upper", 2, {1, 0, 0}, Matrix3::Zero());
  b.body("lower", 3, {1, 0, 0}, Vector3(0, 0, 0.5).asDiagonal());
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper");
  b.joint("elbow", scene::JointKind::Revolute, "upper", "lower", {1, 0, 0});
  return b;
}

double damper(const Simulation& simulation) {
  return model_of(simulation).actuators.front().spring->elasticity.damping;
}

// The mass matrix is {{2 + 12 + 0.5, 6 + 0.5}, {6 + 0.5, 3 + 0.5}}.
TEST(DampingOfJoints, TakesTheArticulatedInertia) {
  const double k = 10, ratio = 0.1;
  for (const bool is_driven : {false, true}) {
    SceneBuilder shoulder = two_links(), elbow = two_links();
    double rotor = 0;
    if (is_driven) {
      for (SceneBuilder* b : {&shoulder, &elbow}) {
        b->drive(b == &shoulder ? "shoulder" : "elbow", 10, 0.02);
      }
      rotor = 2;
    }
    shoulder.scene.springs.push_back({"shoulder", k, 0, {}, ratio});
    elbow.scene.springs.push_back({"elbow", k, 0, {}, ratio});
    const double free_elbow = 14.5 - 6.5 * 6.5 / 3.5 + rotor;
    EXPECT_NEAR(damper(Simulation(shoulder.scene)), 2 * ratio * std::sqrt(k * free_elbow), 1e-12);
    EXPECT_NEAR(damper(Simulation(elbow.scene)), 2 * ratio * std::sqrt(k * (3.5 + rotor)), 1e-12);
  }
}

TEST(DampingOfJoints, RatioOnAnElasticGear) {
  SceneBuilder b = wheel_on_shaft();
  scene::DriveDescription& drive = b.drive("shaft", 1, 1e9);  // so large that the rotor is practically held
  drive.stiffness = 500;
  drive.damping_ratio = 0.05;
  for (const Mode& mode : Simulation(b.scene).natural_modes(2))
    if (mode.frequency > 0) {
      EXPECT_NEAR(2 * kPi * mode.frequency, std::sqrt(500 / kWheelInertia * (1 - 0.05 * 0.05)), 1e-6);
      EXPECT_NEAR(mode.damping_ratio(), 0.05, 1e-4 * 0.05);
    }
}

TEST(DampingOfJoints, StrongDampingCreeps) {
  const double ratio = 500;  // omega is 10/s; the damper's rate times the step is 10
  SceneBuilder b = wheel_on_shaft(0);
  b.scene.initial_joints = {{"shaft", 0.2, 0, {}}};
  b.scene.springs.push_back({"shaft", 40, 0, {}, ratio});
  const double omega = std::sqrt(40 / kWheelInertia);
  Simulation simulation(b.scene, options("em", 1e-3));
  double before = simulation.position(0);
  run(simulation, 3000, [&] {
    ASSERT_LE(simulation.position(0), before);
    before = simulation.position(0);
  });
  EXPECT_NEAR(before, 0.2 * std::exp(-omega / (2 * ratio) * 3), 1e-5);
}

TEST(DampingOfJoints, InertiaMustBeKnown) {
  SceneBuilder b = two_links();
  b.scene.joints.back().mimic = scene::Mimic{"shoulder", 1, 0};
  b.scene.springs.push_back({"shoulder", 10, 0, {"arm.urdf", 7}, 0.1});
  expect_contains(refusal_of(b.scene), "arm.urdf:7: <spring>: damping_ratio needs the inertia");
}

}  // namespace
}  // namespace flexarm::test
