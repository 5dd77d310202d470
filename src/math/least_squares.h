#pragma once
/// Solves dense systems of equations, square or not. In a file of its own, since Eigen's pivoting factorisations take
/// long to compile.

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

/// Returns the x that minimises |matrix x - right|. The matrix must have full column rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Returns the smallest x of all that minimise |matrix x - right|, for a matrix of any rank. The rank is the number of
/// pivots larger than `threshold` times the largest one. Without a `threshold`, this is the round-off of a matrix of
/// this size.
Eigen::VectorXd smallest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                       std::optional<double> threshold = {});

/// Solves matrix x = rights for x, for a square matrix. The result is not finite if the matrix is singular.
Eigen::MatrixXd square_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& rights);

/// Returns the indices of linearly independent rows of a matrix, the one with the largest pivot first. Their pivots are
/// larger than `threshold` times the largest pivot. Returns none if the largest pivot is at most `threshold`.
std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& matrix, double threshold);

/// Returns an orthonormal basis of the column space of a matrix of this rank.
Eigen::MatrixXd column_space(const Eigen::MatrixXd& matrix, Eigen::Index rank);

/// Returns a square F with F^T F = tall^T tall. `tall` must have at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& tall);

}  // namespace flexarm
