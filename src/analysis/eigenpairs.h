#pragma once
/// Eigenpairs of small motions whose eigenvalues are nearest to zero.

#include "analysis/largest_eigenpairs.h"
#include "analysis/linearised_motion.h"

namespace flexarm {

/// The `count` pairs of K phi = mu M phi with mu nearest to -`shift`, nearest first; shift > 0.
/// @throws std::runtime_error if the shifted matrix is singular or the iteration does not converge.
std::vector<Eigenpair> undamped_pairs(const LinearisedMotion& motion, double shift, int count);

/// The `count` pairs of (lambda^2 M + lambda D + K) phi = 0 with lambda nearest to `shift` [1/s], nearest first;
/// shift > 0. Stiffness-proportional damping eta makes eigenvalues crowd at -1/eta. For large models, those that the
/// iteration cannot separate are left out.
/// `free`: motions with K phi = 0, orthonormal in M. The positions along them have no effect, so that their eigenvalues
/// 0 are left out; 2 freedoms() - `free`.cols() pairs remain. Of these, motions along `free` without damping have the
/// eigenvalue 0.
/// @throws std::runtime_error as undamped_pairs().
std::vector<Eigenpair> damped_pairs(const LinearisedMotion& motion, const Eigen::MatrixXd& free, double shift,
                                    int count);

}  // namespace flexarm
