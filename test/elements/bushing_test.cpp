// Tests bushings: the tangent against differences, momentum, work and energy.
#include "elements/bushing.h"

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "model/state.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

using Poses = std::vector<NodePose>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// A full matrix that is symmetric and positive definite.
Matrix6 some_matrix(double scale) {
  Matrix6 root;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) root(i, j) = std::sin(1.0 + 7 * i + 3 * j) + (i == j ? 2 : 0);
  return scale * root * root.transpose();
}

/// Steps of bushings between node 0 and node 1, or the world; forces are those at the end, or means.
class Bushings : public ::testing::TestWithParam<bool> {
 protected:
  struct Action {
    Eigen::VectorXd residual;
    Eigen::MatrixXd tangent;
    double dissipated = 0;
  };

  Action action(const Poses& at_end, const Bushing& bushing, double duration = 0.01) const {
    const std::vector<Vector6> velocities = {0.3 * Vector6::Ones(), -0.1 * Vector6::Ones()};
    ForceStep step{begin, at_end, velocities};
    step.duration = duration;
    step.at_end = GetParam();
    if (step.at_end) step.gamma = 0.6;
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(bushing.reach().size());
    Action out{Eigen::VectorXd(size), Eigen::MatrixXd(size, size)};
    ForceAction action{{out.residual.data(), size}, {out.tangent.data(), size, size}};
    bushing.evaluate(step, bushing.reach().data(), action);
    out.dissipated = action.dissipated;
    return out;
  }

  const NodePoint from{0, {0.1, -0.2, 0.05}, Quaternion(0.9, 0.1, -0.3, 0.2).normalized()},
      to{1, {-0.05, 0.1, 0.3}, Quaternion(0.8, 0.2, 0.3, -0.1).normalized()},
      ground{-1, {0.1, 0.2, 0.9}, Quaternion(0.9, -0.2, 0.1, 0.3).normalized()};
  const Bushing::Law law{some_matrix(30), some_matrix(0.4), {0.02, -0.1, 0.05}};
  const Bushing between{"", from, to, law}, on_ground{"", ground, from, law}, to_ground{"", from, ground, law};
  const Poses begin{turned_node({0, 0, 0}, {0.2, 0.1, -0.3}), turned_node({1, 0.4, -0.2}, {-0.1, 0.5, 0.2})};
  const Poses end{turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3}),
                  turned_node({1.05, 0.42, -0.15}, {-0.1, 0.6, 0.25})};
};

// Central differences with the step 1e-6: truncation 1e-12 times third derivatives, round-off 1e-10 times the forces.
TEST_P(Bushings, HaveTheirTangent) {
  constexpr double h = 1e-6;
  for (const Bushing* bushing : {&between, &on_ground, &to_ground})
    for (const double duration : {0.01, 0.0}) {
      const Action here = action(end, *bushing, duration);
      for (int k = 0; k < here.tangent.cols(); ++k) {
        const auto residual = [&](double way) {
          Vector6 by = Vector6::Zero();
          by[k % 6] = way;
          Poses at = end;
          const int node = bushing->reach()[k / 6];
          at[node] = moved(at[node], by);
          return action(at, *bushing, duration).residual;
        };
        const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
        EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm()) << k;
      }
    }
}

TEST_P(Bushings, AddToNoMomentum) {
  const Eigen::VectorXd here = action(end, between).residual;
  EXPECT_LE((here.segment<3>(0) + here.segment<3>(6)).norm(), 1e-14 * here.norm());
  const double weight = GetParam() ? 1 : 0.5;
  Vector3 moment = Vector3::Zero();
  for (int node = 0; node < 2; ++node) {
    const Vector3 place = (1 - weight) * begin[node].position + weight * end[node].position;
    moment += place.cross(here.segment<3>(6 * node)) + here.segment<3>(6 * node + 3);
  }
  EXPECT_LE(moment.norm(), 1e-14 * here.norm());
}

// The work of the mean forces equals the change of energy and the dissipation, for steps of any size.
TEST_P(Bushings, OfMeansDoExactWork) {
  if (GetParam()) return;  // does not hold for forces at the end
  for (const Bushing* bushing : {&between, &on_ground, &to_ground}) {
    const Action here = action(end, *bushing);
    double work = 0;
    for (std::size_t k = 0; k < bushing->reach().size(); ++k) {
      const int node = bushing->reach()[k];
      work +=
          here.residual.segment<3>(6 * k).dot(end[node].position - begin[node].position) +
          here.residual.segment<3>(6 * k + 3).dot(cayley::increment(begin[node].orientation, end[node].orientation));
    }
    const double before = bushing->energy(state_at(begin), nullptr), after = bushing->energy(state_at(end), nullptr);
    EXPECT_GT(here.dissipated, 0);
    EXPECT_NEAR(work, after - before + here.dissipated, 1e-14 * (before + after + here.dissipated + std::abs(work)));
  }
}

// At an instant the forces are the gradient of the energy.
TEST_P(Bushings, HaveAPotential) {
  for (const Bushing* bushing : {&between, &on_ground, &to_ground}) {
    const Eigen::VectorXd here = action(end, *bushing, 0).residual;
    for (int k = 0; k < here.size() && GetParam(); ++k) {
      const auto energy = [&](double way) {
        Vector6 by = Vector6::Zero();
        by[k % 6] = way;
        Poses at = end;
        const int node = bushing->reach()[k / 6];
        at[node] = moved(at[node], by);
        return bushing->energy(state_at(at), nullptr);
      };
      EXPECT_NEAR(here[k], (energy(1e-5) - energy(-1e-5)) / 2e-5, 1e-8 * here.norm()) << k;
    }
    const ForceMeasures small = bushing->measures(state_at(end), nullptr, bushing->reach().data());
    EXPECT_EQ(small.stiffness, law.stiffness);
    EXPECT_EQ(small.rows.cols(), here.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, Bushings, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
