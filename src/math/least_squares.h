#pragma once
/// Dense systems of equations, square or not. Kept in a file of its own: Eigen's pivoting factorisations take
/// long to compile.

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

/// x that makes |matrix x - right| least; for a matrix of full column rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Of all x that make |matrix x - right| least the smallest; for a matrix of any rank, which is the number of pivots
/// larger than this part of the largest one (round-off of a matrix of this size, where none is given).
Eigen::VectorXd smallest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                       std::optional<double> threshold = {});

/// x of matrix x = rights, for a square matrix; not finite where that is singular.
Eigen::MatrixXd square_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& rights);

/// Rows of a matrix that are linearly independent, the one with the largest pivot first: those whose pivots are larger
/// than `threshold`, and than this part of the largest.
std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& matrix, double threshold);

/// An orthonormal basis of the columns of a matrix of this rank.
Eigen::MatrixXd column_space(const Eigen::MatrixXd& matrix, Eigen::Index rank);

/// F, square, with F^T F = tall^T tall, of a matrix that has at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& tall);

}  // namespace flexarm
