#include "analysis/long_chain.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "analysis/linearised_motion.h"
#include "analysis/node_ways.h"
#include "math/dense_eigenpairs.h"
#include "math/general_vector.h"

namespace flexarm {
namespace {

/// Largest dimension of the Krylov space.
constexpr Eigen::Index kDimensions = 60;
/// A new direction is round-off if at most this part of it is left after it was made orthogonal to the others.
constexpr double kExhausted = 1e-10;

/// Product with A^-1, where A is the last evaluated tangent.
class Inverse {
 public:
  explicit Inverse(StepSystem& system) : system_(system) {}

  Eigen::VectorXd operator()(Eigen::VectorXd b) {
    if (!system_.tangent().solve(b)) throw std::runtime_error("the stiffness is not finite");
    return b;
  }

 private:
  StepSystem& system_;
};

/// The unit vector v of a Krylov space of a symmetric A^-1 with the least v^T A^-1 v, by Lanczos's method.
Eigen::VectorXd least_ritz_vector(Inverse& inverse, Eigen::Index size) {
  const Eigen::Index most = std::min(size, kDimensions);
  Eigen::MatrixXd basis(size, most), images(size, most);
  Eigen::VectorXd next = general_vector(size);
  Eigen::Index count = 0;
  for (double before = next.norm(), left = before; count < most && left > kExhausted * before; ++count) {
    basis.col(count) = next / left;
    images.col(count) = next = inverse(basis.col(count));
    before = next.norm();
    for (int repeat = 0; repeat < 2; ++repeat)
      next -= basis.leftCols(count + 1) * (basis.leftCols(count + 1).transpose() * next);
    left = next.norm();
  }
  const Eigen::MatrixXd projected = basis.leftCols(count).transpose() * images.leftCols(count);
  return basis.leftCols(count) * symmetric_eigenpairs(0.5 * (projected + projected.transpose())).vectors.col(0);
}

}  // namespace

UnstableMotion falling_motion(const Model& model, const State& equilibrium) {
  assert(model.closures.empty());
  StepSystem system(model, exact_equilibrium());
  const double neutral = neutral_curvature(model, equilibrium);
  system.begin_equilibrium(equilibrium, 1.0, neutral);
  if (!system.evaluate(true)) throw std::runtime_error("the stiffness is not finite");
  if (!system.tangent().factorise() || !system.tangent().expanded_solution()) return {};
  Inverse inverse(system);
  const Eigen::VectorXd vector = least_ritz_vector(inverse, system.degrees_of_freedom().unknowns);
  // With A = K + neutral D and w = A^-1 v: w^T A w = v^T A^-1 v.
  const Eigen::VectorXd motion = inverse(vector);
  const std::vector<ComplexVector6> nodes = node_motion_of_solution(system);
  const NodeWays ways(model, nodes);
  const double per_way = vector.dot(motion) / ways.sum_of_squares() - neutral;
  if (per_way * ways.sum_of_squares() >= -neutral * ways.sum_of_squares() - round_off(model, equilibrium, nodes))
    return {};
  return {motion / ways.largest(), per_way, ways.link()};
}

}  // namespace flexarm
