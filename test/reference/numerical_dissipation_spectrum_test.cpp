// Tests the spectrum of numerical dissipation and of structural damping. A bar that vibrates along its axis is a linear
// oscillator, whose motion over many steps follows the roots of the scheme's characteristic polynomial. Without
// damping, the roots approach rho_infinity for stiff bars. Strong damping takes them to zero.
#include <complex>
#include <cstdio>

#include "math/dense_eigenpairs.h"
#include "reference/dynamics_runs.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using Complex = std::complex<double>;
using Polynomial = std::vector<double>;  // lowest coefficient first

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return product;
}

Polynomial operator+(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
  return a;
}

constexpr double kOscillatorStep = 0.01;  // s

/// The scheme on an oscillator, in multiples of the displacement x. z is the factor per step, p = (z - 1)/(z + 1),
/// q = (omega h)^2, and (kappa, nu, b) are those of numerical_dissipation():
///   mean v = dx/h                         h v = 2 p x        (and the strain rate w = v, which has the same rule)
///   y_1 = y_0 + nu (dx - y_0)             y = nu (z - 1) x / (z - 1 + nu)
///   m dv/h + k [mean x + kappa (dx - y) + (b/h) dw + damping] = 0
/// With a damping of r steps, the delayed rate is w / (1 + 2 p). Then the last equation, divided by k (z + 1)/2, is
///   (4/q + 4 b/h^2) p^2 + 1 + 4 kappa p^2 / (2 p + nu (1 - p)) + 2 r p (1 + mu p^2 / (1 + 2 p)) = 0,  mu = min(r, 1).
struct Oscillator {
  double q = 0, r = 0, kappa = 0, nu = 0, b = 0;  // b in units of h^2

  /// Order 0 is without numerical dissipation.
  Oscillator(int order, double rho, double frequency, double damping = 0) : q(frequency * frequency), r(damping) {
    if (order == 0) return;
    const NumericalDissipation d = numerical_dissipation(order, rho, kOscillatorStep);
    kappa = d.stiffness;
    nu = d.forgetting;
    b = d.inertance / (kOscillatorStep * kOscillatorStep);
  }
  Complex value(const Complex& p) const {
    return (4 / q + 4 * b) * p * p + 1.0 + (kappa > 0 ? 4 * kappa * p * p / (2.0 * p + nu * (1.0 - p)) : 0.0) +
           2 * r * p * (1.0 + mu() * p * p / (1.0 + 2.0 * p));
  }
  double mu() const { return std::min(r, 1.0); }
  Polynomial polynomial() const {
    const Polynomial average = nu > 0 ? Polynomial{nu, 2 - nu} : Polynomial{1};
    const Polynomial dissipation = nu > 0 ? Polynomial{0, 0, 4 * kappa} : Polynomial{0, 2 * kappa};
    Polynomial sum = Polynomial{1, 0, 4 / q + 4 * b} * average + dissipation;
    if (r > 0) sum = sum * Polynomial{1, 2} + Polynomial{0, 2 * r} * Polynomial{1, 2, mu()} * average;
    while (sum.back() == 0) sum.pop_back();
    return sum;
  }
  std::vector<Complex> roots() const {
    const Polynomial c = polynomial();
    const int n = static_cast<int>(c.size()) - 1;
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      companion(i, n - 1) = -c[i] / c[n];
      if (i > 0) companion(i, i - 1) = 1;
    }
    const Eigen::VectorXcd found = dense_eigenpairs(companion).values;
    std::vector<Complex> values(found.data(), found.data() + n);
    for (Complex& p : values)
      for (int iteration = 0; iteration < 3; ++iteration) {  // refinement by Newton's method
        Complex f = c[n], slope = 0;
        for (int i = n - 1; i >= 0; --i) slope = slope * p + f, f = f * p + c[i];
        if (std::abs(slope) > 0) p -= f / slope;
      }
    return values;
  }
};

Complex factor(const Complex& p) {
  return (1.0 + p) / (1.0 - p);
}

/// p of the root with the largest modulus.
Complex slowest(const Oscillator& oscillator) {
  Complex largest = 0;
  double modulus = -1;
  for (const Complex& p : oscillator.roots())
    if (std::abs(factor(p)) > modulus) largest = p, modulus = std::abs(factor(p));
  return largest;
}

struct Case {
  int order;
  double rho, frequency;  ///< omega h
  double damping = 0;     ///< eta / h
  Oscillator oscillator() const { return {order, rho, frequency, damping}; }
  friend std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << "order " << c.order << ", rho " << c.rho << ", omega h = " << c.frequency << ", eta = " << c.damping
               << " h";
  }
};

/// A clamped axial element. The consistent mass at its free end is a third of its 1 kg.
Simulation bar(const Case& c) {
  SceneBuilder b;
  const double omega = c.frequency / kOscillatorStep;
  b.beam("bar", {{1, 0, 0}}, scene::DirectSection{omega * omega / 3, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  b.joint("clamp", scene::JointKind::Fixed, "world", "bar");
  b.scene.links.back().beam->stiffness_proportional_damping = c.damping * kOscillatorStep;
  b.scene.integrator.scheme = c.order == 0 ? "em" : "edmc" + std::to_string(c.order);
  if (c.order > 0) b.scene.integrator.rho_infinity = c.rho;
  b.scene.integrator.step = kOscillatorStep;
  b.scene.integrator.tolerance = 1e-10;
  return Simulation(b.scene, full_newton());
}

int tip_node(const Simulation& simulation) {
  return std::get<BeamGroup<2>>(model_of(simulation).beams).elements.front().nodes[1];
}

/// Sets the state to the mode x = Re(u z^n) of the root p.
void start_on(Simulation& simulation, const Oscillator& o, const Complex& p, const Complex& u) {
  State state = state_of(simulation);
  NodeState& tip = state.nodes[tip_node(simulation)];
  StrainMemory& memory = state.strain_memory.front();
  tip.position.x() = 1 + u.real();
  tip.velocity.x() = memory.rate[0] = (2.0 * p * u).real() / kOscillatorStep;
  memory.delayed_rate[0] = (2.0 * p * u / (1.0 + 2.0 * p)).real() / kOscillatorStep;
  memory.average[0] = o.nu == 0 ? 0 : (o.nu * 2.0 * p * u / (2.0 * p + o.nu * (1.0 - p))).real();
  restore(simulation, state);
}

class Spectrum : public ::testing::TestWithParam<Case> {};

// The bar starts in the mode of the slowest root z, so that its end follows u Re(z^n). The energy is a quadratic form
// of the state in this mode. It decays as |z|^{2n} up to a periodic factor.
TEST_P(Spectrum, MotionFollowsTheSlowestRoot) {
  const Case c = GetParam();
  const Oscillator o = c.oscillator();
  const Complex p = slowest(o), z = factor(p);
  // The poles of the delay and of the average amplify the round-off of p.
  const double magnified = 1 + (c.damping > 0 ? 1 / std::abs(1.0 + 2.0 * p) : 0) +
                           (c.damping > 0 && o.nu > 0 ? 1 / std::abs(o.nu + (2 - o.nu) * p) : 0);
  ASSERT_LT(std::abs(o.value(p)), 100 * kEpsilon * magnified * (1 + std::abs(4 / o.q * p * p)));
  const double amplitude = 0.05;
  Simulation simulation = bar(c);
  start_on(simulation, o, p, amplitude);
  const double begin = simulation.energies().total();
  // Each step rounds the position, which is near 1, and so h v. The amplitude has the same error; for slow waves it is
  // larger by 1/(omega h).
  const double modulus = std::abs(z);
  const int steps = modulus > 1 - 1e-9 ? 500 : std::clamp(static_cast<int>(std::log(1e-5) / std::log(modulus)), 3, 500);
  double defect = 0;
  Complex u = amplitude;
  run(simulation, steps, [&] {
    u *= z;
    defect = std::max(defect, std::abs(state_of(simulation).nodes[tip_node(simulation)].position.x() - 1 - u.real()));
  });
  const double round_off = 10 * kEpsilon * steps * (1 + 1 / c.frequency);
  EXPECT_LT(defect, round_off) << c;
  Simulation theory = bar(c);
  start_on(theory, o, p, u);
  const double end = simulation.energies().total(), expected = theory.energies().total();
  // The bound: d(E)/E = 2 d(u)/|u|, times two for each of two pairs of the state's four parts.
  EXPECT_NEAR(end / expected, 1, 8 * round_off / std::abs(u)) << c;
  std::printf(
      "order %d rho %.2f omega h %8.2e eta %.0e h: |z| = %.6f; %3d steps, defect %.1e of %.1e, energy %.2e of first\n",
      c.order, c.rho, c.frequency, c.damping, modulus, steps, defect, round_off, end / begin);
}

std::vector<Case> spectrum_cases() {
  std::vector<Case> cases;
  for (const int order : {1, 2})
    for (const double rho : {0.0, 0.3, 0.5, 0.8, 0.95})
      for (const double frequency : {1e-2, 1e-1, 1.0, 3.0, 1e1, 1e2, 1e3, 1e4})
        cases.push_back({order, rho, frequency});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Frequencies, Spectrum, ::testing::ValuesIn(spectrum_cases()));

std::vector<Case> damped_cases() {
  std::vector<Case> cases;
  for (const int order : {0, 1, 2})
    for (const double damping : {1e-3, 1e-1, 1.0, 1e2, 1e4})
      for (const double frequency : {1e-2, 1.0, 1e2, 1e4}) cases.push_back({order, 0.8, frequency, damping});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Damped, Spectrum, ::testing::ValuesIn(damped_cases()));

// For r <= 1 and an infinite frequency, two roots are near p = -1/r. With p = (d - 1)/r, the polynomial over (1 + 2 p)
// is d^2 + r/2 to leading order in r. So |d| = sqrt(r/2) and 1 - |z| = 2 r. The next order is smaller by sqrt(r).
TEST(SpectralRadius, WeakDampingOfHighFrequencies) {
  for (const double r : {1e-4, 1e-3, 1e-2}) {
    const double modulus = std::abs(factor(slowest(Oscillator(0, 1, 1e8, r))));
    EXPECT_NEAR((1 - modulus) / (2 * r), 1, std::sqrt(r)) << "eta = " << r << " h";
  }
}

// For r >= 1 the polynomial is 2 r p (1 + p)^2 + (1 + 2 p) (1 + 4 p^2/q). One root is slow: the spring creeps through
// the damper, p = -1/(2 r). Two roots are near p = -1, with |1 + p| = sqrt((1 + 4/q) / 2 r) =: d and |z| = d/2. The
// bound is twice that.
TEST(SpectralRadius, StrongDampingLeavesNothingToRing) {
  for (const double frequency : {1e-1, 1.0, 1e2, 1e6})
    for (const double damping : {1e4, 1e6, 1e8}) {
      const Oscillator o(0, 1, frequency, damping);
      const Complex slow = slowest(o);
      EXPECT_NEAR(slow.real(), -0.5 / damping, 1 / (damping * damping));
      const double bound = std::sqrt((1 + 4 / o.q) / (2 * damping));
      for (const Complex& p : o.roots()) {
        if (p != slow) {
          EXPECT_LT(std::abs(factor(p)), bound) << "omega h = " << frequency;
        }
      }
    }
}

// For a resolved frequency, the exact factor is exp(s) with s^2/q + r s + 1 = 0. In s = 2 p the scheme adds at most r
// s^3/4, and log z = s + s^3/12. Together this is an error of w^3 (1/12 + zeta/4 / sqrt(1 - zeta^2)), with w = sqrt(q)
// = |s| and the damping ratio zeta = r w/2. The bound is twice that.
TEST(SpectralRadius, ResolvedFrequenciesHaveTheirDamping) {
  for (const double w : {1e-3, 1e-2, 1e-1})
    for (const double zeta : {1e-3, 1e-2, 0.1, 0.5}) {
      const double damped = std::sqrt(1 - zeta * zeta);
      const Complex exact = w * Complex(-zeta, damped);
      Complex z = factor(slowest(Oscillator(0, 1, w, 2 * zeta / w)));
      if (z.imag() < 0) z = std::conj(z);
      const double bound = 2 * std::pow(w, 3) * (1.0 / 12 + zeta / 4 / damped);
      EXPECT_LT(std::abs(std::log(z) - exact), bound + 100 * kEpsilon) << "zeta = " << zeta;
    }
}

// Let P = (1 + rho)/(1 - rho). To first order in 1/q, the polynomial times its denominator is
//   first order:  (p + P)^2 / P^2 + 4 p^2/q = 0                       |p + P| = 2 P^2 / sqrt(q),
//   second order: (p + P)^3 / (3 P^2) + (4 p^2/q) (p + P/3) = 0       |p + P| = 2 P^{5/3} / q^{1/3},
// So the modulus of every root tends to rho as |dz| = 2 |p + P| / (1 + P)^2. The bound is twice that.
TEST(SpectralRadius, TendsToRhoInfinity) {
  for (const int order : {1, 2})
    for (const double rho : {0.0, 0.3, 0.5, 0.8, 0.95}) {
      const double P = (1 + rho) / (1 - rho);
      for (const double frequency : {1e4, 1e6, 1e8}) {
        const double q = frequency * frequency;
        const double dp = order == 1 ? 2 * P * P / std::sqrt(q) : 2 * std::pow(P, 5.0 / 3) / std::cbrt(q);
        // A root of multiplicity n is accurate to the n-th root of the coefficients' round-off.
        const double numerical = 10 * P * std::pow(kEpsilon, 1.0 / (order + 1));
        for (const Complex& p : Oscillator(order, rho, frequency).roots())
          EXPECT_LT(std::abs(factor(p) + rho), 2 * (2 * dp + numerical) / std::pow(1 + P, 2))
              << "order " << order << ", rho " << rho << ", omega h = " << frequency;
      }
    }
}

// The loss per step at resolved frequencies: for small q, p = i sqrt(q)/2 + delta with
//   first order:  delta = -kappa q / 4                                1 - |z| = kappa q / 2,
//   second order: delta = -c q^2 / 32, c = 4 kappa (2 - nu) / nu^2    1 - |z| = c q^2 / 16,
// The next terms are smaller by a factor of the order of sqrt(q) P.
TEST(SpectralRadius, ResolvedFrequenciesLoseLittle) {
  for (const double rho : {0.0, 0.5, 0.8}) {
    const double frequency = 1e-2, q = frequency * frequency, next = 10 * frequency * (1 + rho) / (1 - rho);
    const Oscillator first(1, rho, frequency), second(2, rho, frequency);
    const double c = 4 * second.kappa * (2 - second.nu) / (second.nu * second.nu);
    EXPECT_NEAR((1 - std::abs(factor(slowest(first)))) / (first.kappa * q / 2), 1, next) << rho;
    EXPECT_NEAR((1 - std::abs(factor(slowest(second)))) / (c * q * q / 16), 1, next) << rho;
  }
}

}  // namespace
}  // namespace flexarm::test
