#pragma once
/// An independent, mesh-free solution of the static Reissner-Simo beam: shooting on its ordinary differential
/// equations.

#include "reference_cantilever.h"

namespace flexarm::test {

/// Pose of the tip of a cantilever of one piece (line or arc, possibly twisted), with a section matrix about the
/// centreline. Axes are those of the undeformed link.
///
/// Equations: r' = Lambda (e_1 + Gamma), Lambda' = Lambda (Upsilon_0 + K)^, m' = -r' x n, n = force, {Gamma, K} =
/// C^{-1} {N, M}. Newton's method finds the root moment for m(L) = moment, by the classical Runge-Kutta method with
/// `steps` steps (error of order 4). The load is applied in ten increments.
/// @throws std::runtime_error if Newton's method fails.
Pose shooting_tip(const Cantilever& cantilever, const Matrix6& stiffness, int steps = 3000);

/// Diagonal section matrix.
Matrix6 stiffness_matrix(const scene::DirectSection& section);

}  // namespace flexarm::test
