#include "analysis/modes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <tuple>

#include "analysis/eigenpairs.h"
#include "analysis/linearised_motion.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using Complex = std::complex<double>;

/// Number of modes that are computed beyond the requested ones.
constexpr int kExtraModes = 12;

/// x* A x; its real part is an energy.
double energy(const LinearisedMotion::Matrix& matrix, const Eigen::VectorXcd& x) {
  const Eigen::VectorXd real = x.real(), imaginary = x.imag();
  return real.dot(matrix * real) + imaginary.dot(matrix * imaginary);
}

/// Sum of the magnitudes of the diagonal.
double trace(const LinearisedMotion::Matrix& matrix) {
  return Eigen::SparseMatrix<double>(matrix).diagonal().cwiseAbs().sum();
}

/// An eigenvector, with energies that show how accurate its eigenvalue is.
struct Motion {
  Mode mode;
  double mass, damping;  ///< x* M x and x* D x
  double round_off;      ///< of x* K x, and of the solver, in which mu = 0 has the eigenvalue 1/shift

  Motion(const LinearisedMotion& system, double shift, Eigen::VectorXcd vector) : mode(system.expand(vector)) {
    Complex largest = 0;
    for (const ComplexVector6& motion : mode.node_motion)
      for (Eigen::Index i = 0; i < motion.size(); ++i)
        if (std::abs(motion[i]) > std::abs(largest)) largest = motion[i];
    if (largest == 0.0) largest = 1;  // all nodes are held by prescribed coordinates
    for (ComplexVector6& motion : mode.node_motion) motion /= largest;
    for (Complex& motion : mode.coordinate_motion) motion /= largest;
    vector /= largest;
    mass = std::abs(energy(system.mass(), vector));
    damping = std::abs(energy(system.damping(), vector));
    round_off = system.round_off(mode.node_motion) + kStiffnessRoundOff * shift * mass;
  }
  Mode with(Complex eigenvalue) && {
    mode.frequency = std::abs(eigenvalue.imag()) / (2 * kPi);
    mode.rate = eigenvalue.real();
    return std::move(mode);
  }
};

/// lambda for mu = -lambda^2. If mu < 0, it is the growing one of two. Of two conjugate mu, one gives a growing and the
/// other a decaying oscillation.
Complex undamped_eigenvalue(Complex mu) {
  return mu.imag() == 0 && mu.real() < 0 ? std::sqrt(-mu.real()) : Complex(0, 1) * std::sqrt(mu);
}

Mode undamped_mode(const LinearisedMotion& system, double shift, const Eigenpair& pair) {
  Motion motion(system, shift, pair.vector);
  const double tolerance = motion.round_off / motion.mass;
  if (std::abs(pair.value) <= tolerance) return std::move(motion).with(0);
  if (pair.value.imag() != 0 && (!system.is_circulatory() || std::abs(pair.value.imag()) <= tolerance)) {
    // Two real eigenvalues that are nearly equal: K is symmetric except for round-off and for the error of elements of
    // curved beams. Any combination of their vectors is an eigenvector.
    const Complex phase = pair.value.imag() > 0 ? Complex(1, 0) : Complex(0, 1);
    const Eigen::VectorXd part = (phase * pair.vector).real();
    return Motion(system, shift, part.cast<Complex>()).with(undamped_eigenvalue(pair.value.real()));
  }
  return std::move(motion).with(undamped_eigenvalue(pair.value));
}

/// None if the pair belongs to a free motion, or is the conjugate of another pair. `shift`: of mu.
std::optional<Mode> damped_mode(const LinearisedMotion& system, double shift, const Eigenpair& pair) {
  Complex lambda = pair.value;
  if (lambda.imag() < 0) return std::nullopt;
  Motion motion(system, shift, pair.vector);
  const double size = std::abs(lambda);
  if (std::max(size * size * motion.mass, size * motion.damping) <= motion.round_off) return std::nullopt;
  // Errors of the energies, and of 1/(lambda/s - 1), which the solver knows to the round-off of its largest value.
  const double s = std::sqrt(shift);
  const double tolerance = motion.round_off / std::abs(2.0 * lambda * motion.mass + motion.damping) +
                           kStiffnessRoundOff * std::norm(lambda - s) / s;
  const bool may_grow = system.is_circulatory() || lambda.imag() == 0;  // theorem of Kelvin, Tait and Chetaev
  if (std::abs(lambda.real()) <= tolerance || (lambda.real() > 0 && !may_grow)) lambda.real(0);
  return std::move(motion).with(lambda);
}

bool comes_before(const Mode& a, const Mode& b) {
  const auto key = [](const Mode& mode) {
    return std::make_tuple(-std::max(mode.rate, 0.0), std::hypot(2 * kPi * mode.frequency, mode.rate));
  };
  return key(a) < key(b);
}

}  // namespace

std::vector<Mode> natural_modes(const Model& model, const State& state, int count, double contact_time) {
  assert(contact_time > 0);
  const LinearisedMotion system(model, state, contact_time);
  // Compute more modes than requested, so that the scale is that of elastic modes even if there are free motions.
  const int computed = std::min(count + kExtraModes, system.freedoms());
  if (count <= 0 || computed <= 0) return {};
  // The shift makes free mechanisms solvable. A first pass finds the scale of the wanted eigenvalues, a second one with
  // a shift far below them loses no digits.
  double shift = std::max(1e-8 * trace(system.stiffness()) / trace(system.mass()), 1e-12);
  std::vector<Eigenpair> pairs = undamped_pairs(system, shift, computed);
  double scale = 0;
  for (const Eigenpair& pair : pairs) scale = std::max(scale, pair.value.real());
  if (scale > 0) {
    shift = 1e-3 * scale;
    pairs = undamped_pairs(system, shift, computed);
  }
  std::vector<Mode> modes;
  modes.reserve(pairs.size());
  for (const Eigenpair& pair : pairs) modes.push_back(undamped_mode(system, shift, pair));
  if (system.is_damped()) {
    // Free motions follow from K alone, with damping or without, so they stay.
    modes.erase(std::remove_if(modes.begin(), modes.end(), [](const Mode& mode) { return !mode.is_free(); }),
                modes.end());
    const int wanted = std::min(2 * (count + static_cast<int>(modes.size())) + kExtraModes, 2 * system.freedoms());
    for (const Eigenpair& pair : damped_pairs(system, std::sqrt(shift), wanted))
      if (std::optional<Mode> mode = damped_mode(system, shift, pair)) modes.push_back(std::move(*mode));
  }
  std::sort(modes.begin(), modes.end(), comes_before);
  modes.resize(std::min<std::size_t>(modes.size(), count));
  return modes;
}

}  // namespace flexarm
