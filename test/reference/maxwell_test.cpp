// Tests beams of several Maxwell elements against closed forms: relaxation, creep and oscillation of a rod, and what
// holds for any motion: energy, momenta, limits.
#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>

#include "reference/dynamics_runs.h"
#include "support/dense_solution.h"
#include "support/loops.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

using MaxwellElements = std::vector<scene::MaxwellElement>;

constexpr double kRodStiffness = 1000;  // EA of a rod of length 1 m [N]
const MaxwellElements kTwoElements = {{0.4, 0.02}, {0.3, 0.5}};

/// A rod of one element along x, between a carriage on a rail and the world.
SceneBuilder rod_on_carriage(const MaxwellElements& branches, const std::string& motion, double step) {
  SceneBuilder b;
  b.scene.integrator.step = step;
  b.scene.integrator.tolerance = 1e-12;
  b.body("carriage", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "carriage", Vector3::Zero(), Vector3::UnitX());
  b.beam("rod", {{1, 0, 0}}, section(kRodStiffness, 400, 10, 10, 0.3, 1e-3, 1e-3), 1, 1).maxwell = branches;
  b.joint("weld", scene::JointKind::Fixed, "carriage", "rod");
  b.scene.motions.push_back({"rail", TimeFunction::parse(motion), {}});
  close_loop(b, "wall", scene::JointKind::Fixed, "world", "rod", {1, 0, 0});
  return b;
}

double rod_force(const Simulation& simulation) {
  constexpr std::size_t kRod = 2;  // after the world and the carriage
  return simulation.section(kRod, 0.5).resultant[0];
}

// The rod is pulled at a constant rate for 0.1 s and then held. The force of a branch is EA g tau rate (1 -
// exp(-t/tau)) until then, and decays with exp(-t/tau) afterwards. The scheme solves both without an error.
TEST(Maxwell, HeldStrainRelaxes) {
  const double rate = 0.3, pull = 0.1;
  const SceneBuilder b = rod_on_carriage(kTwoElements, "-0.3*min(t, 0.1)", 0.01);
  Simulation simulation(b.scene);
  run(simulation, 100, [&] {
    const double t = simulation.time(), before = std::min(t, pull), after = t - before;
    double expected = kRodStiffness * rate * before;
    for (const auto& [ratio, tau] : kTwoElements)
      expected += kRodStiffness * ratio * tau * rate * -std::expm1(-before / tau) * std::exp(-after / tau);
    EXPECT_NEAR(rod_force(simulation), expected, 1e-10 * kRodStiffness);
  });
}

/// Largest error of the force if the strain is A (1 - cos(w t)), whose Maxwell force solves e' = A w sin(w t) - e/tau.
double error_of_shaking(double step) {
  const double w = 20, size = 0.05;
  const SceneBuilder b = rod_on_carriage(kTwoElements, "-0.05*(1-cos(20*t))", step);
  Simulation simulation(b.scene);
  double error = 0;
  run(simulation, static_cast<int>(std::lround(1 / step)), [&] {
    const double t = simulation.time();
    double expected = size * (1 - std::cos(w * t));
    for (const auto& [ratio, tau] : kTwoElements) {
      const double x = w * tau;
      expected += ratio * size * x / (1 + x * x) * (std::sin(w * t) - x * std::cos(w * t) + x * std::exp(-t / tau));
    }
    error = std::max(error, std::abs(rod_force(simulation) / kRodStiffness - expected));
  });
  return error;
}

TEST(Maxwell, ShakenRodHasSecondOrder) {
  EXPECT_NEAR(observed_order(error_of_shaking(5e-3), error_of_shaking(2.5e-3)), 2, 0.05);
}

// ---------------------------------------------------------------- oscillation

constexpr double kEndMass = 2, kOwnMass = 0.3, kPullOnRod = 30;

/// A rod with a mass at its end, which a constant force pulls from t = 0 on.
SceneBuilder pulled_rod(const MaxwellElements& branches, double stiffness, double step) {
  SceneBuilder b;
  b.scene.integrator.step = step;
  b.scene.integrator.tolerance = 1e-12;
  b.beam("rod", {{1, 0, 0}}, section(stiffness, 400, 10, 10, kOwnMass, 1e-3, 1e-3), 1, 1).maxwell = branches;
  b.joint("clamp", scene::JointKind::Fixed, "world", "rod");
  b.body("mass", kEndMass, Vector3::Zero(), Matrix3::Identity());
  b.joint("weld", scene::JointKind::Fixed, "rod", "mass", {1, 0, 0});
  b.load("mass", Vector3::Zero(), {kPullOnRod, 0, 0});
  b.probe("end", "mass", Vector3::Zero());
  return b;
}

double stretch_after(const SceneBuilder& b, double time) {
  Simulation simulation(b.scene);
  run(simulation, static_cast<int>(std::lround(time / b.scene.integrator.step)));
  return simulation.probe(0).pose.position.x() - 1;
}

/// The same by the eigenvalues of x' = A x + b for x = {u, u', e_1, e_2, ...}. An element of order 1 moves the mass of
/// the rod with a third of it at the end.
double stretch_by_eigenvalues(const MaxwellElements& branches, double time) {
  const auto size = static_cast<Eigen::Index>(branches.size() + 2);
  const double mass = kEndMass + kOwnMass / 3;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  a(0, 1) = 1;
  a(1, 0) = -kRodStiffness / mass;
  for (Eigen::Index i = 2; i < size; ++i) {
    const auto& [ratio, tau] = branches[i - 2];
    a(1, i) = -kRodStiffness * ratio / mass;
    a(i, 1) = 1;
    a(i, i) = -1 / tau;
  }
  Eigen::VectorXcd rest = Eigen::VectorXcd::Zero(size);
  rest[0] = kPullOnRod / kRodStiffness;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a);
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  const Eigen::VectorXcd parts = complex_solution(vectors, -rest);
  std::complex<double> u = rest[0];
  for (Eigen::Index i = 0; i < size; ++i) u += vectors(0, i) * parts[i] * std::exp(solver.eigenvalues()[i] * time);
  return u.real();
}

TEST(Maxwell, OscillatesWithTheEigenvaluesOfItsLinearSystem) {
  const double end = 0.6, expected = stretch_by_eigenvalues(kTwoElements, end);
  const auto error = [&](const std::string& scheme, double step) {
    SceneBuilder b = pulled_rod(kTwoElements, kRodStiffness, step);
    b.scene.integrator.scheme = scheme;
    return std::abs(stretch_after(b, end) - expected);
  };
  for (const char* scheme : {"em", "em0", "em_symmetric"}) {
    const double coarse = error(scheme, 4e-3), fine = error(scheme, 2e-3);
    EXPECT_NEAR(observed_order(coarse, fine), 2, 0.05) << scheme;
    // The phase is late by (w h)^2 / 12 per radian: 0.5 % for w h = 0.06 and 17 rad.
    EXPECT_LT(fine, 0.01 * kPullOnRod / kRodStiffness) << scheme;
  }
}

// The mass comes to rest where the stiffness at rest holds it.
TEST(Maxwell, CreepsToTheStiffnessAtRest) {
  // The slowest part decays with exp(-t/tau') with tau' <= tau (1 + ratio) = 0.65 s: exp(-20/0.65) = 4e-14.
  EXPECT_NEAR(stretch_after(pulled_rod(kTwoElements, kRodStiffness, 5e-3), 20), kPullOnRod / kRodStiffness, 1e-10);
}

// Relaxation that takes forever adds its stiffness; relaxation at once adds nothing.
TEST(Maxwell, LimitsOfTheRelaxationTime) {
  const auto stretch = [](const MaxwellElements& branches, double stiffness) {
    return stretch_after(pulled_rod(branches, stiffness, 2e-3), 0.3);
  };
  const double scale = kPullOnRod / kRodStiffness;
  EXPECT_NEAR(stretch({{0.5, 1e12}}, kRodStiffness), stretch({}, 1.5 * kRodStiffness), 1e-10 * scale);
  EXPECT_NEAR(stretch({{0.5, 1e-12}}, kRodStiffness), stretch({}, kRodStiffness), 1e-9 * scale);
}

// ---------------------------------------------------------------- energy and momenta

/// A free beam with two rigid bodies, which bends and turns by some radians.
SceneBuilder relaxing_flight(double step) {
  SceneBuilder b;
  b.scene.integrator.step = step;
  b.scene.integrator.tolerance = 1e-12;
  scene::BeamDescription& beam = b.beam("beam", {{1, 0, 0}}, section(1e4, 4e3, 20, 25, 1, 2e-3, 1e-3), 4, 2);
  beam.maxwell = kTwoElements;
  b.joint("flight", scene::JointKind::Floating, "world", "beam");
  b.body("weight", 0.5, {0, 0.2, 0.1}, 1e-2 * Matrix3::Identity());
  b.joint("weld", scene::JointKind::Fixed, "beam", "weight", {1, 0, 0});
  initial_field(b, "beam", {0.3, -0.2, 0.5}, {2, 3, 5});
  return b;
}

TEST(Maxwell, EnergyAndMomentaAreExact) {
  for (const char* scheme : {"em", "em_symmetric", "edmc1", "edmc2"}) {
    SceneBuilder b = relaxing_flight(0.01);
    b.scene.integrator.scheme = scheme;
    Simulation simulation(b.scene);
    InvariantDrift drift(simulation);
    run(simulation, 200, [&] { drift.observe(); });
    EXPECT_GT(simulation.energies().dissipated, 1e-4 * simulation.energies().kinetic) << scheme;
    EXPECT_LT(drift.energy(), 1e-10) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-10) << scheme;
    EXPECT_LT(drift.momentum(), 1e-10) << scheme;
  }
}

TEST(Maxwell, DissipatesInEveryStep) {
  Simulation simulation(relaxing_flight(0.01).scene);
  double before = 0;
  run(simulation, 300, [&] {
    EXPECT_GE(simulation.energies().dissipated, before);
    before = simulation.energies().dissipated;
  });
}

/// Tip of a cantilever after 0.4 s, which a force bends by half its length. The force starts smoothly, so that it
/// excites no waves that steps do not resolve.
Vector3 bent_tip(double step) {
  SceneBuilder b;
  b.scene.integrator.step = step;
  b.scene.integrator.tolerance = 1e-12;
  b.beam("beam", {{1, 0, 0}}, section(1e4, 4e3, 20, 25, 1, 2e-3, 1e-3), 4, 2).maxwell = kTwoElements;
  b.joint("clamp", scene::JointKind::Fixed, "world", "beam");
  b.load("beam", {1, 0, 0}, {0, 10, 20}, {3, 0, 0}, "(1-cos(10*t))^2");
  b.probe("tip", "beam", {1, 0, 0});
  Simulation simulation(b.scene);
  run(simulation, static_cast<int>(std::lround(0.4 / step)));
  return simulation.probe(0).pose.position;
}

TEST(Maxwell, LargeMotionHasSecondOrder) {
  const Vector3 a = bent_tip(4e-3), b = bent_tip(2e-3), c = bent_tip(1e-3);
  EXPECT_GT((a - Vector3::UnitX()).norm(), 0.5);
  EXPECT_NEAR(observed_order((a - b).norm(), (b - c).norm()), 2, 0.1);
}

// ---------------------------------------------------------------- statics, refusals

TEST(Maxwell, EquilibriumHasRelaxed) {
  SceneBuilder b = pulled_rod(kTwoElements, kRodStiffness, 1e-3);
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  EXPECT_NEAR(simulation.probe(0).pose.position.x() - 1, kPullOnRod / kRodStiffness, 1e-11);
  const Energies rest = simulation.energies();
  EXPECT_NEAR(rest.strain, 0.5 * kPullOnRod * kPullOnRod / kRodStiffness, 1e-10);
  run(simulation, 50);  // it stays there
  EXPECT_NEAR(simulation.probe(0).pose.position.x() - 1, kPullOnRod / kRodStiffness, 1e-11);
  EXPECT_NEAR(simulation.energies().dissipated, 0, 1e-12);
}

TEST(Maxwell, OtherSchemesAreRefused) {
  for (const char* scheme : {"em4", "m1", "m2", "std", "beta1", "newmark", "hht3"}) {
    SceneBuilder b = pulled_rod(kTwoElements, kRodStiffness, 1e-3);
    b.scene.integrator.scheme = scheme;
    expect_contains(refusal_of(b.scene), "has no <maxwell> elements");
  }
}

}  // namespace
}  // namespace flexarm::test
