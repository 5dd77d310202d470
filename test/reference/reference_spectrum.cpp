// Reference natural frequencies of plane beams; see reference_spectrum.h.
#include "reference_spectrum.h"

#include <cmath>

#include <Eigen/Core>

namespace flexarm::test {
namespace {

// Entries grow like cosh(beta L) and cancel in the determinant. Extended precision keeps 1e-12.
using Matrix = Eigen::Matrix<long double, 4, 4>;
using Vector = Eigen::Matrix<long double, 4, 1>;

/// exp(A) by scaling and squaring of the Taylor series.
Matrix exponential(Matrix a) {
  int squarings = 0;
  for (; a.cwiseAbs().rowwise().sum().maxCoeff() > 0.5L; ++squarings) a *= 0.5L;
  Matrix sum = Matrix::Identity(), term = Matrix::Identity();
  for (int k = 1; k <= 20; ++k) {
    term = Matrix(term * a) / static_cast<long double>(k);
    sum += term;
  }
  for (; squarings > 0; --squarings) sum = Matrix(sum * sum);
  return sum;
}

}  // namespace

long double frequency_determinant(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                  long double omega_squared) {
  const long double L = beam.length, EI = beam.bending_stiffness, f = beam.shear_compliance, N = beam.axial_force;
  const long double stretch = 1 + N * beam.axial_compliance, m = beam.mass, j = beam.rotary_inertia;
  // Unknowns are {w / L, theta, M L / EI, Q L^2 / EI} over s / L.
  const long double shear = f * EI / (L * L), force = N * L * L / EI;
  const long double w_mass = omega_squared * m * L * L * L * L / EI, w_inertia = omega_squared * j * L * L / EI;
  Matrix a = Matrix::Zero();
  a(0, 1) = stretch - shear * force;
  a(0, 3) = shear;
  a(1, 2) = 1;
  a.row(2) = force * a.row(0);
  a(2, 1) -= w_inertia;
  a(2, 3) -= stretch;
  a(3, 0) = -w_mass;
  const Matrix transfer = exponential(a);

  // There are two free amplitudes at the root. A body there takes Q = -omega^2 m w and M = -omega^2 J theta from the
  // beam.
  const auto body_mass = [&](const EndCondition& end) { return omega_squared * end.mass * L * L * L / EI; };
  const auto body_inertia = [&](const EndCondition& end) { return omega_squared * end.inertia * L / EI; };
  Vector first = Vector::Zero(), second = Vector::Zero();
  if (root.translates) {
    first[0] = 1;
    first[3] = -body_mass(root);
  } else {
    first[3] = 1;
  }
  if (root.rotates) {
    second[1] = 1;
    second[2] = -body_inertia(root);
  } else {
    second[2] = 1;
  }
  const Vector u = transfer * first, v = transfer * second;
  const auto translation = [&](const Vector& x) { return tip.translates ? x[3] - body_mass(tip) * x[0] : x[0]; };
  const auto rotation = [&](const Vector& x) { return tip.rotates ? x[2] - body_inertia(tip) * x[1] : x[1]; };
  return translation(u) * rotation(v) - translation(v) * rotation(u);
}

std::vector<double> exact_frequencies(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                      int count) {
  // Searches in beta = sqrt(omega), in which the roots have about equal distances, with a hundredth of this distance.
  const double unit = std::sqrt(beam.bending_stiffness / beam.mass) / (beam.length * beam.length);
  const auto determinant = [&](long double beta) {
    const long double omega = unit * beta * beta;
    return frequency_determinant(beam, root, tip, omega * omega);
  };
  std::vector<double> frequencies;
  const long double step = 0.03L;
  long double left = step, at_left = determinant(left);
  while (static_cast<int>(frequencies.size()) < count && left < 1000) {
    const long double right = left + step, at_right = determinant(right);
    if ((at_left < 0) != (at_right < 0)) {
      long double low = left, high = right;
      for (int k = 0; k < 60; ++k) {
        const long double middle = 0.5L * (low + high);
        ((determinant(middle) < 0) == (at_left < 0) ? low : high) = middle;
      }
      frequencies.push_back(static_cast<double>(unit * low * low));
    }
    left = right;
    at_left = at_right;
  }
  return frequencies;
}

}  // namespace flexarm::test
