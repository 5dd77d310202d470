// Tests beams in the additive weak form, whose rows are conjugate to total rotation vectors.
#include "study_schemes/additive_beam.h"

#include "elements/kernel_checks.h"
#include "elements/tested_step.h"
#include "study_schemes/newmark_beam.h"
#include "study_schemes/rotary_inertia.h"

namespace flexarm {
namespace {

using namespace test;

template <class Count>
class AdditiveBeam : public ::testing::Test {};
TYPED_TEST_SUITE(AdditiveBeam, NodeCounts);

/// A random step with total rotation vectors at the nodes.
template <int Nodes>
struct AdditiveStep {
  RandomStep<Nodes> step;
  std::array<Vector6, Nodes - 1> strain_rates;

  AdditiveStep(RandomSource& random, double damping = 0) : step(random, 0.5) {
    step.set_interpolation(random, Interpolation::Total);
    step.element.stiffness_damping = damping;
    for (Vector6& rate : strain_rates) rate = random.vector6();
  }
  ElementSystem<Nodes> internal(const ElementNodes<Nodes>& nodes, const NewmarkRule* rule, bool with_tangent,
                                std::array<PointKinematics, Nodes - 1>* points = nullptr) const {
    return evaluate(endpoint_internal<Nodes, AdditiveForm>, nodes, rule, with_tangent, points);
  }
  double strain_energy(const ElementNodes<Nodes>& nodes) const {
    std::array<PointKinematics, Nodes - 1> points;
    internal(nodes, nullptr, false, &points);
    return step.strain_energy(points);
  }
  ElementSystem<Nodes> spin_internal(const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                                     bool with_tangent) const {
    return evaluate(endpoint_internal<Nodes>, nodes, rule, with_tangent, nullptr);
  }
  /// Rotary inertia by Newmark's rule.
  ElementSystem<Nodes> inertia(const ElementNodes<Nodes>& nodes, bool with_tangent, WeakForm form) const {
    ElementSystem<Nodes> system;
    system.set_zero();
    for_each_mass_point(
        step.element, nodes, with_tangent,
        [&](int k, const InterpolatedRotation<double>& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
          const RotaryRate rate = newmark_rotary_rate(step.element.mass_points[k].inertia, step.begin_mass_rotations[k],
                                                      point.rotation, step.mass_points[k], kNewmarkRule);
          if (form == WeakForm::Additive)
            add_additive_rotary_rate(step.element, nodes, k, rate, with_tangent, system);
          else
            add_rotary_rate(step.element, k, rate, generalised, with_tangent, system);
        });
    return system;
  }
  /// The nodes with coordinate `column` of {r_i, theta_i} changed by h.
  ElementNodes<Nodes> perturbed_vector(int column, double h) const {
    if (column % 6 < 3) return step.perturbed(column, h);
    ElementNodes<Nodes> out = step.nodes;
    const int i = column / 6;
    Vector3& theta = out.rotation_vector[i];
    theta[column % 6 - 3] += h;
    step.set_orientation(i, so3::exp_quaternion(theta) * step.reference_orientation[i], out);
    return out;
  }
  /// Compares the tangent with respect to {r, theta} with differences of kernel(nodes, with_tangent).
  template <class Kernel>
  void expect_tangent_in_vectors(const Kernel& kernel) const {
    const ElementSystem<Nodes> system = kernel(step.nodes, true);
    const double scale = std::max(largest(system.tangent), largest(system.residual));
    for (int column = 0; column < 6 * Nodes; ++column) {
      const Eigen::Matrix<double, 6 * Nodes, 1> expected =
          difference([&](double h) { return kernel(perturbed_vector(column, h), false).residual; });
      EXPECT_LE(largest(system.tangent.col(column) - expected), difference_tolerance * scale) << "column " << column;
    }
  }
  /// The same with respect to {r, spin}, after additive_to_spins.
  template <class Kernel>
  void expect_tangent_in_spins(const Kernel& kernel) const {
    expect_consistent_tangent<Nodes>(step, [&](const ElementNodes<Nodes>& nodes, bool with) {
      ElementSystem<Nodes> system = kernel(nodes, with);
      additive_to_spins<Nodes>(nodes, with, system);
      return system;
    });
  }
  /// Multiplies the moment rows by T_i^T.
  Eigen::Matrix<double, 6 * Nodes, 1> to_vectors(Eigen::Matrix<double, 6 * Nodes, 1> residual) const {
    for (int i = 0; i < Nodes; ++i)
      residual.template segment<3>(6 * i + 3) =
          (so3::tangent(step.nodes.rotation_vector[i]).transpose() * residual.template segment<3>(6 * i + 3)).eval();
    return residual;
  }

 private:
  template <class Kernel>
  ElementSystem<Nodes> evaluate(const Kernel& kernel, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                                bool with_tangent, std::array<PointKinematics, Nodes - 1>* points) const {
    std::array<PointKinematics, Nodes - 1> end;
    std::array<Vector6, Nodes - 1> new_rates;
    ElementSystem<Nodes> system;
    system.set_zero();
    kernel(step.element, nodes, rule, step.begin_points.data(), strain_rates.data(), with_tangent, end.data(),
           new_rates.data(), system, nullptr);
    if (points) *points = end;
    return system;
  }
};

TYPED_TEST(AdditiveBeam, TangentInRotationVectors) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  for (const double damping : {0.0, 0.2}) {
    const AdditiveStep<N> additive(random, damping);
    additive.expect_tangent_in_vectors(
        [&](const ElementNodes<N>& nodes, bool with) { return additive.internal(nodes, &kNewmarkRule, with); });
  }
}

TYPED_TEST(AdditiveBeam, StaticTangentIsSymmetric) {
  constexpr int N = TypeParam::value;
  RandomSource random(2);
  for (int k = 0; k < 5; ++k) {
    const AdditiveStep<N> additive(random);
    const ElementSystem<N> system = additive.internal(additive.step.nodes, nullptr, true);
    EXPECT_LE(largest(system.tangent - system.tangent.transpose()), kRoundOff * largest(system.tangent));
  }
}

TYPED_TEST(AdditiveBeam, ForcesAreTheGradientOfTheStrainEnergy) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  const AdditiveStep<N> additive(random);
  const ElementSystem<N> system = additive.internal(additive.step.nodes, nullptr, false);
  for (int column = 0; column < 6 * N; ++column) {
    const double slope =
        scalar_difference([&](double h) { return additive.strain_energy(additive.perturbed_vector(column, h)); });
    EXPECT_NEAR(system.residual[column], slope, difference_tolerance * largest(system.residual));
  }
}

TYPED_TEST(AdditiveBeam, TangentInSpins) {
  constexpr int N = TypeParam::value;
  RandomSource random(4);
  for (const double damping : {0.0, 0.2}) {
    const AdditiveStep<N> additive(random, damping);
    additive.expect_tangent_in_spins(
        [&](const ElementNodes<N>& nodes, bool with) { return additive.internal(nodes, &kNewmarkRule, with); });
  }
}

TYPED_TEST(AdditiveBeam, ResidualInSpinsIsTheAdditiveOneTurned) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  const AdditiveStep<N> additive(random, 0.2);
  const ElementNodes<N>& nodes = additive.step.nodes;
  ElementSystem<N> system = additive.internal(nodes, &kNewmarkRule, false);
  const auto expected = system.residual;
  additive_to_spins<N>(nodes, false, system);
  EXPECT_LE(largest(additive.to_vectors(system.residual) - expected), kRoundOff * largest(expected));
}

// If all nodes have the same rotation, T is the same everywhere, and both weak forms have the same rows.
TYPED_TEST(AdditiveBeam, AgreesWithTheSpinFormWhereTheRotationIsUniform) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  AdditiveStep<N> additive(random, 0.2);
  RandomStep<N>& step = additive.step;
  const Vector3 turn = 2 * random.vector();
  for (int i = 0; i < N; ++i) {
    step.nodes.rotation_vector[i] = turn;
    step.set_orientation(i, so3::exp_quaternion(turn) * step.undeformed_orientation[i]);
  }
  ElementSystem<N> system = additive.internal(step.nodes, &kNewmarkRule, false);
  additive_to_spins<N>(step.nodes, false, system);
  const ElementSystem<N> expected = additive.spin_internal(step.nodes, &kNewmarkRule, false);
  EXPECT_LE(largest(system.residual - expected.residual), kRoundOff * largest(expected.residual));
  EXPECT_NEAR(system.dissipated, expected.dissipated, kRoundOff * std::abs(expected.dissipated));

  ElementSystem<N> inertia = additive.inertia(step.nodes, false, WeakForm::Additive);
  additive_to_spins<N>(step.nodes, false, inertia);
  const ElementSystem<N> spin_inertia = additive.inertia(step.nodes, false, WeakForm::Spin);
  EXPECT_LE(largest(inertia.residual - spin_inertia.residual), kRoundOff * largest(spin_inertia.residual));
}

TYPED_TEST(AdditiveBeam, TangentsOfRotaryInertia) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  const AdditiveStep<N> additive(random);
  const auto inertia = [&](const ElementNodes<N>& nodes, bool with) {
    return additive.inertia(nodes, with, WeakForm::Additive);
  };
  additive.expect_tangent_in_vectors(inertia);
  additive.expect_tangent_in_spins(inertia);
}

TYPED_TEST(AdditiveBeam, RotaryInertiaInSpinsIsTheAdditiveOneTurned) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  const AdditiveStep<N> additive(random);
  ElementSystem<N> system = additive.inertia(additive.step.nodes, false, WeakForm::Additive);
  const auto expected = system.residual;
  additive_to_spins<N>(additive.step.nodes, false, system);
  EXPECT_LE(largest(additive.to_vectors(system.residual) - expected), kRoundOff * largest(expected));
}

}  // namespace
}  // namespace flexarm
