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
/// The shift of mu, as a part of the largest wanted mu.
constexpr double kPartOfScale = 1e-3;
/// A motion with less than this part outside the space of others is in that space.
constexpr double kOutsideSpace = 1e-6;

/// |x* A x|.
double energy(const LinearisedMotion::Matrix& matrix, const Eigen::VectorXcd& x) {
  const Eigen::VectorXd real = matrix * x.real(), imaginary = matrix * x.imag();
  return std::abs(x.dot(real + Complex(0, 1) * imaginary));
}

/// Sum of the magnitudes of the diagonal.
double trace(const LinearisedMotion::Matrix& matrix) {
  return Eigen::SparseMatrix<double>(matrix).diagonal().cwiseAbs().sum();
}

/// An eigenvector, with energies that show how accurate its eigenvalue is.
struct Motion {
  Mode mode;
  double mass, damping, stiffness;  ///< |x* M x|, |x* D x| and |x* K x|
  double round_off;                 ///< of x* K x, and of the solver, in which mu = 0 has the eigenvalue 1/shift

  Motion(const LinearisedMotion& system, double shift, Eigen::VectorXcd vector) : mode(system.expand(vector)) {
    Complex largest = 0;
    for (const ComplexVector6& motion : mode.node_motion)
      for (Eigen::Index i = 0; i < motion.size(); ++i)
        if (std::abs(motion[i]) > std::abs(largest)) largest = motion[i];
    if (largest == 0.0) largest = 1;  // all nodes are held by prescribed coordinates
    for (ComplexVector6& motion : mode.node_motion) motion /= largest;
    for (Complex& motion : mode.coordinate_motion) motion /= largest;
    vector /= largest;
    mass = energy(system.mass(), vector);
    damping = energy(system.damping(), vector);
    stiffness = energy(system.stiffness(), vector);
    round_off = system.round_off(mode.node_motion) + kStiffnessRoundOff * shift * mass;
  }
  /// Whether nothing resists the motion. In an eigenvector, phi* K phi has the error of the vector squared, so that it
  /// may show this where the eigenvalue has the solver's error.
  bool is_free(Complex mu) const { return std::min(std::abs(mu) * mass, stiffness) <= round_off; }
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
  if (motion.is_free(pair.value)) return std::move(motion).with(0);
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

/// The largest mu that is above its round-off, or 0.
double scale_of(const LinearisedMotion& system, double shift, const std::vector<Eigenpair>& pairs) {
  double scale = 0;
  for (const Eigenpair& pair : pairs)
    if (pair.value.real() > scale && !Motion(system, shift, pair.vector).is_free(pair.value)) scale = pair.value.real();
  return scale;
}

/// An orthonormal basis, in M, of the space of these motions.
Eigen::MatrixXd basis_of(const LinearisedMotion& system, const std::vector<Eigen::VectorXcd>& motions) {
  Eigen::MatrixXd basis(system.unknowns(), static_cast<Eigen::Index>(motions.size()));
  Eigen::Index size = 0;
  // Each vector has a real multiple, or its conjugate is another of the vectors.
  for (const Eigen::VectorXcd& motion : motions)
    for (Eigen::VectorXd part : {Eigen::VectorXd(motion.real()), Eigen::VectorXd(motion.imag())}) {
      const auto length = [&] { return std::sqrt(std::max(0.0, part.dot(system.mass() * part))); };
      const double whole = length();
      for (int pass = 0; pass < 2; ++pass)
        part -= basis.leftCols(size) * (basis.leftCols(size).transpose() * (system.mass() * part));
      if (size < basis.cols() && length() > kOutsideSpace * whole) basis.col(size++) = part / length();
    }
  return basis.leftCols(size);
}

}  // namespace

std::vector<Mode> natural_modes(const Model& model, const State& state, int count) {
  const LinearisedMotion system(model, state);
  // Compute more modes than requested, so that the scale is that of elastic modes even if there are free motions.
  const int computed = std::min(count + kExtraModes, system.freedoms());
  if (count <= 0 || computed <= 0) return {};
  // The shift makes free mechanisms solvable. A first pass finds the scale of the wanted eigenvalues, a second one with
  // a shift far below them loses no digits.
  double shift = std::max(1e-8 * trace(system.stiffness()) / trace(system.mass()), 1e-12);
  std::vector<Eigenpair> pairs = undamped_pairs(system, shift, computed);
  const double scale = scale_of(system, shift, pairs);
  if (scale > 0) {
    shift = kPartOfScale * scale;
    pairs = undamped_pairs(system, shift, computed);
  }
  std::vector<Mode> modes;
  modes.reserve(pairs.size());
  std::vector<Eigen::VectorXcd> free;
  for (const Eigenpair& pair : pairs) {
    Mode mode = undamped_mode(system, shift, pair);
    if (mode.is_free()) free.push_back(pair.vector);
    // Free motions follow from K alone, with damping or without. Others are those of the damped mechanism, if it is
    // one.
    if (mode.is_free() || !system.is_damped()) modes.push_back(std::move(mode));
  }
  if (system.is_damped()) {
    if (scale == 0) shift = std::pow(trace(system.damping()) / trace(system.mass()), 2);  // there is no stiffness
    const Eigen::MatrixXd basis = basis_of(system, free);
    const auto most = 2 * system.freedoms() - static_cast<int>(basis.cols());
    const int wanted = std::min(2 * (count + static_cast<int>(free.size())) + kExtraModes, most);
    for (const Eigenpair& pair : damped_pairs(system, basis, std::sqrt(shift), wanted))
      if (std::optional<Mode> mode = damped_mode(system, shift, pair)) modes.push_back(std::move(*mode));
  }
  std::sort(modes.begin(), modes.end(), comes_before);
  modes.resize(std::min<std::size_t>(modes.size(), count));
  return modes;
}

}  // namespace flexarm
