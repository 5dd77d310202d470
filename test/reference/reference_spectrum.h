#pragma once
/// Exact natural frequencies of uniform straight beams in one plane, from roots of the frequency determinant.

#include <array>
#include <vector>

namespace flexarm::test {

/// Small motions of a Reissner (Timoshenko) beam about a straight state stretched by an axial force. Linearised in the
/// material coordinate s, with lambda = 1 + N / EA:
///   w' = (Q - N theta) / GA + lambda theta,     theta' = M / EI,
///   M' = -lambda Q + N w' - omega^2 j theta,    Q' = -omega^2 m w.
/// Bernoulli's beam is the limit of zero shear compliance and rotary inertia.
struct PlaneBeam {
  double length = 1, bending_stiffness = 1;           ///< [m], [N m^2]
  double shear_compliance = 0, axial_compliance = 0;  ///< 1/GA, 1/EA [1/N]
  double mass = 1, rotary_inertia = 0;                ///< per length [kg/m], [kg m]
  double axial_force = 0;                             ///< N, tension positive [N]
};

/// Support of an end. The inertia forces of a body at the end are included.
struct EndCondition {
  bool translates = false, rotates = false;  ///< transverse motion, rotation in the plane
  double mass = 0, inertia = 0;              ///< of a body with its centre at the end [kg], [kg m^2]
};
constexpr EndCondition kClamped{false, false, 0, 0}, kPinned{false, true, 0, 0}, kFree{true, true, 0, 0};

/// The lowest `count` circular frequencies > 0 [rad/s], relative accuracy 1e-12.
std::vector<double> exact_frequencies(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                      int count);

/// Frequency determinant at omega^2; negative values belong to growing motions. A zero at omega = 0 is a critical axial
/// force.
long double frequency_determinant(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                  long double omega_squared);

}  // namespace flexarm::test
