// Tests small motions of a flexible arm with a hub under a position servo, against a linear model of Euler-Bernoulli
// elements.
#include <array>
#include <complex>

#include <fmt/format.h>

#include "math/dense_eigenpairs.h"
#include "reference/dynamics_runs.h"
#include "support/dense_solution.h"

namespace flexarm::test {
namespace {

constexpr double kArmLength = 1, kArmBending = 10, kArmMass = 1, kHub = 0.05;  // m, N m^2, kg/m, kg m^2
constexpr double kProportional = 40, kDerivative = 4;                          // N m/rad, N m s/rad
// The motion is linear up to amplitude^2. The beam is Euler's up to beta^2 EI / GA of a mode with the wave number beta;
// the moving modes have beta < 8/m.
constexpr double kAmplitude = 1e-3, kArmShear = 1e8;  // rad, N
constexpr double kModel = kAmplitude * kAmplitude + 64 * kArmBending / kArmShear;
constexpr double kEnd = 0.8;  // s
// The set point is amplitude (1 - 9/8 cos(6 t) + 1/8 cos(18 t)). Its first three derivatives are zero at the start, so
// that modes that are not resolved in time have no influence.
struct Harmonic {
  double part, rate;
};
constexpr std::array<Harmonic, 2> kHarmonics{{{-9 / 8.0, 6}, {1 / 8.0, 18}}};

/// A beam from a hinge at x = 0 to a free end, with cubic elements. Unknowns are the slope at the hinge, then
/// deflection and slope of each further node.
class LinearArm {
 public:
  explicit LinearArm(int elements)
      : stiffness_(Eigen::MatrixXd::Zero(2 * elements + 2, 2 * elements + 2)), mass_(stiffness_) {
    const double l = kArmLength / elements;
    Eigen::Matrix4d stiffness, mass;
    stiffness << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l,
        -6 * l, 4 * l * l;
    mass << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l,
        -3 * l * l, -22 * l, 4 * l * l;
    for (int e = 0; e < elements; ++e) {
      stiffness_.block<4, 4>(2 * e, 2 * e) += kArmBending / (l * l * l) * stiffness;
      mass_.block<4, 4>(2 * e, 2 * e) += kArmMass * l / 420 * mass;
    }
    const int count = 2 * elements + 1;  // without the deflection of the hinge
    stiffness_ = stiffness_.bottomRightCorner(count, count).eval();
    mass_ = mass_.bottomRightCorner(count, count).eval();
    mass_(0, 0) += kHub;
    stiffness_(0, 0) += kProportional;
  }

  /// Angle of the hub and deflection of the tip at a time, from rest at time 0.
  Eigen::Vector2d at(double time) const {
    using Complex = std::complex<double>;
    const int n = static_cast<int>(mass_.rows());
    // The permanent part: the amplitude as a rigid rotation, and the response to the harmonics.
    Eigen::VectorXd stays(n), begin(n), begin_rate = Eigen::VectorXd::Zero(n);
    stays[0] = 1;
    for (int i = 1; i < n; i += 2) stays.segment<2>(i) << kArmLength * (i + 1) / (n - 1), 1;
    begin = stays *= kAmplitude;
    for (const Harmonic& harmonic : kHarmonics) {
      const Complex rate(0, harmonic.rate);
      Eigen::MatrixXcd dynamic = stiffness_.cast<Complex>() + rate * rate * mass_.cast<Complex>();
      dynamic(0, 0) += rate * kDerivative;
      Eigen::VectorXcd answer = Eigen::VectorXcd::Zero(n);
      answer[0] = kAmplitude * harmonic.part * (kProportional + rate * kDerivative);
      answer = complex_solution(dynamic, answer);
      stays += (answer * std::exp(rate * time)).real();
      begin += answer.real();
      begin_rate += (rate * answer).real();
    }

    // The transient part, by modes of the undamped system, with the states {omega q, q'}.
    const SymmetricEigenpairs masses = symmetric_eigenpairs(mass_);
    const Eigen::MatrixXd of_unit_mass = masses.vectors * masses.values.cwiseSqrt().cwiseInverse().asDiagonal();
    const SymmetricEigenpairs modes = symmetric_eigenpairs(of_unit_mass.transpose() * stiffness_ * of_unit_mass);
    const Eigen::MatrixXd shapes = of_unit_mass * modes.vectors;
    const Eigen::VectorXd omega = modes.values.cwiseSqrt();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    matrix.topRightCorner(n, n).diagonal() = omega;
    matrix.bottomLeftCorner(n, n).diagonal() = -omega;
    matrix.bottomRightCorner(n, n) = -kDerivative * shapes.row(0).transpose() * shapes.row(0);
    Eigen::VectorXd start(2 * n);
    const Eigen::MatrixXd to_modes = shapes.transpose() * mass_;
    start << -omega.cwiseProduct(to_modes * begin), -to_modes * begin_rate;
    const Eigenpairs roots = dense_eigenpairs(matrix);
    const Eigen::VectorXcd parts = complex_solution(roots.vectors, start.cast<Complex>());
    const Eigen::VectorXd states =
        (roots.vectors * (roots.values * time).array().exp().matrix().cwiseProduct(parts)).real();
    const Eigen::VectorXd x = stays + shapes * states.head(n).cwiseQuotient(omega);
    return {x[0], x[n - 2]};
  }

 private:
  Eigen::MatrixXd stiffness_, mass_;
};

Eigen::Vector2d simulated(const char* scheme, int steps) {
  SceneBuilder b;
  b.beam("arm", {{kArmLength, 0, 0}}, section(1e6, kArmShear, 5, kArmBending, kArmMass, 1e-7, 1e-7), 12, 3)
      .hubs.push_back({scene::HubDescription::End::Start, 0, {0, 0, kHub}, {}});
  b.joint("hinge", scene::JointKind::Revolute, "world", "arm");
  b.probe("tip", "arm", {kArmLength, 0, 0});
  b.servo("hinge", kProportional, kDerivative).set_point =
      TimeFunction::parse(fmt::format("{}*(1-9/8*cos(6*t)+1/8*cos(18*t))", kAmplitude));
  Simulation simulation(b.scene, options(scheme, kEnd / steps, 1e-12));
  run(simulation, steps);
  return {simulation.position(0), simulation.probe(0).pose.position.y()};
}

TEST(ServoArm, FollowsTheLinearModelAtSecondOrder) {
  const Eigen::Vector2d expected = LinearArm(40).at(kEnd);
  ASSERT_GT(std::abs(expected[1] - kArmLength * expected[0]), 0.02 * kAmplitude) << "it bends";
  for (const char* scheme : {"em", "m1", "newmark"}) {
    const Eigen::Vector2d coarse = simulated(scheme, 100), fine = simulated(scheme, 200);
    for (const int i : {0, 1}) {
      SCOPED_TRACE(fmt::format("{}, {}", scheme, i == 0 ? "hub" : "tip"));
      const double model = kModel * kAmplitude, error = std::abs(fine[i] - expected[i]);
      // The tolerance of the observed order contains the difference of the models relative to the error.
      EXPECT_NEAR(std::log2((coarse[i] - expected[i]) / (fine[i] - expected[i])), 2, 0.05 + 1.5 * model / error);
      // The value is extrapolated from both steps. At most a tenth of the correction remains at fourth order.
      EXPECT_NEAR(fine[i] + (fine[i] - coarse[i]) / 3, expected[i], model + 0.1 * error);
    }
  }
}

}  // namespace
}  // namespace flexarm::test
