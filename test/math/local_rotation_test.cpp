/// Tests the strain-invariant interpolation of rotations and its generalised shape functions, mostly against the
/// formulas of the theory in long double.

#include "math/local_rotation.h"

#include <gtest/gtest.h>

#include "rotation_samples.h"
#include "support/node_counts.h"

namespace flexarm::test {
namespace {

/// An interpolated quantity passes through a logarithm, two products and an exponential. Each has about 16 roundings.
constexpr double interpolation_roundoff = 64 * epsilon;

template <int Nodes>
using NodalMatrices = std::array<Matrix, Nodes>;
template <int Nodes>
using NodalVectors = std::array<Vector, Nodes>;

/// Returns nodal rotations that differ by at most `spread` [rad] from an arbitrary common rotation.
template <int Nodes>
NodalMatrices<Nodes> nodal_rotations(Samples& samples, double spread) {
  const Matrix common = so3::exp(samples.vector());
  NodalMatrices<Nodes> result;
  for (Matrix& rotation : result) rotation = so3::exp(spread * samples.of_length(1.0)) * common;
  return result;
}

/// The formulas in the form of the theory, with local vectors in the reference frame, in long double.
template <int Nodes>
struct Reference {
  using V = Vector3T<long double>;
  using M = Matrix3T<long double>;
  M rotation;
  V curvature;
  GeneralisedShapeFunctions<Nodes, long double> generalised;

  Reference(const NodalMatrices<Nodes>& rotations, const ShapeFunctions<Nodes>& shape) {
    constexpr int a = reference_nodes<Nodes>().first, b = reference_nodes<Nodes>().second;
    std::array<M, Nodes> nodal;
    for (int i = 0; i < Nodes; ++i) nodal[i] = rotations[i].template cast<long double>();
    const V relative = so3::log(nodal[a].transpose() * nodal[b]);
    const M frame = nodal[a] * so3::exp(0.5L * relative);
    V theta = V::Zero(), rate = V::Zero();
    std::array<M, Nodes> inverse, share;
    M mean = M::Zero(), mean_rate = M::Zero();
    for (int i = 0; i < Nodes; ++i) {
      const V local = so3::log(frame.transpose() * nodal[i]);
      const long double value = shape.values[i], slope = shape.derivatives[i];
      inverse[i] = so3::tangent(local).inverse();
      theta += value * local;
      rate += slope * local;
      mean += value * inverse[i];
      mean_rate += slope * inverse[i];
      share[i].setZero();
    }
    const long double angle = relative.norm();
    const M skew = (angle > 0 ? std::tan(angle / 4) / angle : 0.25L) * so3::hat(relative);
    share[a] += 0.5L * (M::Identity() + skew);
    share[b] += 0.5L * (M::Identity() - skew);
    const M tangent = so3::tangent(theta), tangent_rate = so3::tangent_derivative(theta, rate);
    for (int i = 0; i < Nodes; ++i) {
      const long double value = shape.values[i], slope = shape.derivatives[i];
      const M local = value * tangent * inverse[i] + (M::Identity() - tangent * mean) * share[i];
      const M local_rate = (value * tangent_rate + slope * tangent) * inverse[i] -
                           (tangent_rate * mean + tangent * mean_rate) * share[i];
      generalised.values[i] = frame * local * frame.transpose();
      generalised.derivatives[i] = frame * local_rate * frame.transpose();
    }
    rotation = frame * so3::exp(theta);
    curvature = tangent.transpose() * rate;
  }
};

template <typename Count>
class LocalRotationTest : public ::testing::Test {
 protected:
  static constexpr int nodes = Count::value;

  /// Calls check(nodal rotations, shape functions at a point) for spreads from zero to large ones.
  template <typename Check>
  void for_each_element(const Check& check) {
    for (const double spread : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 1.2}) {
      const NodalMatrices<nodes> rotations = nodal_rotations<nodes>(samples_, spread);
      for (const double xi : {-1.0, -0.77, 0.0, 0.34, 1.0}) {
        SCOPED_TRACE(::testing::Message() << nodes << " nodes, spread " << spread << ", xi " << xi);
        check(rotations, lagrange<nodes>(xi));
      }
    }
  }
  Samples samples_;
};

TYPED_TEST_SUITE(LocalRotationTest, NodeCounts);

/// Returns the largest sum of |I^i'| over the points, about 12 for five nodes: the factor by which round-off in a nodal
/// rotation grows.
template <int Nodes>
double slope_sum(const ShapeFunctions<Nodes>& shape) {
  return 1 + shape.derivatives.cwiseAbs().sum() + shape.values.cwiseAbs().sum();
}

TYPED_TEST(LocalRotationTest, AgreesWithTheTheorysFormulas) {
  constexpr int nodes = TypeParam::value;
  this->for_each_element([](const NodalMatrices<nodes>& rotations, const ShapeFunctions<nodes>& shape) {
    const Reference<nodes> expected(rotations, shape);
    const double tolerance = interpolation_roundoff * slope_sum(shape);
    GeneralisedShapeFunctions<nodes> generalised;
    const LocalRotations<nodes> local(rotations);
    const InterpolatedRotation<> section =
        LocalRotationVariation<nodes>(local).evaluate(shape.values, shape.derivatives, generalised);
    EXPECT_LT(distance(section.rotation, expected.rotation), tolerance);
    EXPECT_LT(distance(section.curvature, expected.curvature), tolerance);
    for (int i = 0; i < nodes; ++i) {
      EXPECT_LT(distance(generalised.values[i], expected.generalised.values[i]), tolerance);
      EXPECT_LT(distance(generalised.derivatives[i], expected.generalised.derivatives[i]), tolerance);
    }
    const InterpolatedRotation<> strains_only = local.evaluate(shape.values, shape.derivatives);
    EXPECT_EQ(strains_only.rotation, section.rotation);
    EXPECT_EQ(strains_only.curvature, section.curvature);
  });
}

TEST(HalfWayBetweenTwoNodes, AgreesWithTheTheorysFormulas) {
  Samples samples;
  const ShapeFunctions<2> shape = lagrange<2>(0.0);
  // Angles between the nodes. Near 2 pi, theta/sin(theta) grows without bounds, and so does the effect of round-off in
  // theta.
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0}) {
    const Matrix common = so3::exp(samples.vector());
    const NodalMatrices<2> rotations{common, so3::exp(samples.of_length(angle)) * common};
    const Reference<2> expected(rotations, shape);
    const double tolerance = interpolation_roundoff * slope_sum(shape);
    const LocalRotations<2> local(rotations);
    GeneralisedShapeFunctions<2> generalised;
    const InterpolatedRotation<> section = evaluate_half_way(local, shape.derivatives[1], generalised);
    EXPECT_LT(distance(section.rotation, expected.rotation), tolerance);
    EXPECT_LT(distance(section.curvature, expected.curvature), tolerance);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT(distance(generalised.values[i], expected.generalised.values[i]), tolerance);
      EXPECT_LT(distance(generalised.derivatives[i], expected.generalised.derivatives[i]), tolerance);
    }
    const InterpolatedRotation<> strains_only = evaluate_half_way(local, shape.derivatives[1]);
    EXPECT_EQ(strains_only.rotation, section.rotation);
    EXPECT_EQ(strains_only.curvature, section.curvature);
  }
}

// An element has a uniform curvature if it is bent uniformly by less than 2 pi between neighbouring reference nodes.
// Spins of its nodes move its sections as differences show. Beyond pi, only the signs of the quaternions tell the
// angle.
TYPED_TEST(LocalRotationTest, BendsThroughPi) {
  constexpr int nodes = TypeParam::value;
  const Vector axis = this->samples_.of_length(1.0);
  for (const double turn : {1.0, 3.1, 3.2, 4.5, 6.0}) {
    std::array<QuaternionT<double>, nodes> rotations;
    for (int i = 0; i < nodes; ++i)
      rotations[i] = so3::exp_quaternion(Vector(0.5 * turn * (1 + node_coordinate<nodes>(i)) * axis));
    const LocalRotations<nodes> local(rotations);
    for (const double xi : {-0.77, 0.1, 0.9}) {
      const ShapeFunctions<nodes> shape = lagrange<nodes>(xi);
      GeneralisedShapeFunctions<nodes> generalised;
      const InterpolatedRotation<> section =
          LocalRotationVariation<nodes>(local).evaluate(shape.values, shape.derivatives, generalised);
      // T^-1 and the tangent of a quarter of the angle grow towards 2 pi.
      const double tolerance = interpolation_roundoff * slope_sum(shape) / std::sin(0.5 * turn) * turn;
      EXPECT_LT(distance(section.curvature, Vector(0.5 * turn * axis)), tolerance) << turn;
      EXPECT_LT(distance(section.rotation, so3::exp(Vector(0.5 * turn * (1 + xi) * axis))), tolerance) << turn;
      for (int i = 0; i < nodes; ++i)
        for (int k = 0; k < 3; ++k) {
          const auto moved = [&](double h) {
            auto changed = rotations;
            changed[i] = so3::exp_quaternion(Vector(h * Vector::Unit(k))) * rotations[i];
            return LocalRotations<nodes>(changed).evaluate(shape.values, shape.derivatives).rotation;
          };
          // Truncation and round-off of central differences: h^2 times the third derivative, and epsilon / h.
          const double h = 1e-5;
          const Matrix difference = (moved(h) - moved(-h)) / (2 * h);
          const Vector spin = so3::vee(Matrix(difference * section.rotation.transpose()));
          EXPECT_LT(distance(spin, Vector(generalised.values[i].col(k))), 1e-9 / std::pow(std::sin(0.5 * turn), 2))
              << turn;
        }
    }
  }
}

TYPED_TEST(LocalRotationTest, PassesThroughTheNodes) {
  constexpr int nodes = TypeParam::value;
  const NodalMatrices<nodes> rotations = nodal_rotations<nodes>(this->samples_, 1.0);
  const LocalRotations<nodes> local(rotations);
  for (int i = 0; i < nodes; ++i) {
    const ShapeFunctions<nodes> shape = lagrange<nodes>(node_coordinate<nodes>(i));
    const double tolerance = interpolation_roundoff * slope_sum(shape);
    GeneralisedShapeFunctions<nodes> generalised;
    LocalRotationVariation<nodes>(local).evaluate(shape.values, shape.derivatives, generalised);
    EXPECT_LT(distance(local.evaluate(shape.values, shape.derivatives).rotation, rotations[i]), tolerance);
    for (int j = 0; j < nodes; ++j) {
      const Matrix expected = (i == j ? 1.0 : 0.0) * Matrix::Identity();
      EXPECT_LT(distance(generalised.values[j], expected), tolerance);
    }
  }
}

TYPED_TEST(LocalRotationTest, CurvatureIsTheRotationsDerivative) {
  constexpr int nodes = TypeParam::value;
  this->for_each_element([](const NodalMatrices<nodes>& rotations, const ShapeFunctions<nodes>& shape) {
    const LocalRotations<nodes> local(rotations);
    const InterpolatedRotation<> section = local.evaluate(shape.values, shape.derivatives);
    // Along the line, only the interpolated local vector changes.
    const Vector theta = local.interpolate(shape.values), slope = local.interpolate(shape.derivatives);
    const Matrix rate = derivative(so3::exp(perturbed(theta, slope))) * local.reference_rotation();
    const Matrix skew = section.rotation.transpose() * rate;
    EXPECT_LT(distance(section.curvature, so3::vee(skew)), interpolation_roundoff * slope_sum(shape));
  });
}

TYPED_TEST(LocalRotationTest, GeneralisedShapeFunctionsArePartitionOfUnity) {
  constexpr int nodes = TypeParam::value;
  this->for_each_element([](const NodalMatrices<nodes>& rotations, const ShapeFunctions<nodes>& shape) {
    const LocalRotationVariation<nodes> variation{LocalRotations<nodes>(rotations)};
    GeneralisedShapeFunctions<nodes> generalised;
    variation.evaluate(shape.values, shape.derivatives, generalised);
    Matrix sum = Matrix::Zero(), derivative_sum = Matrix::Zero();
    for (int i = 0; i < nodes; ++i) {
      sum += generalised.values[i];
      derivative_sum += generalised.derivatives[i];
    }
    EXPECT_LT(distance(sum, Matrix::Identity()), interpolation_roundoff);
    EXPECT_LT(distance(derivative_sum, Matrix::Zero()), interpolation_roundoff * slope_sum(shape));
  });
}

TYPED_TEST(LocalRotationTest, GeneralisedShapeFunctionsAreTheVariation) {
  constexpr int nodes = TypeParam::value;
  this->for_each_element([this](const NodalMatrices<nodes>& rotations, const ShapeFunctions<nodes>& shape) {
    const LocalRotationVariation<nodes> variation{LocalRotations<nodes>(rotations)};
    GeneralisedShapeFunctions<nodes> generalised;
    const InterpolatedRotation<> section = variation.evaluate(shape.values, shape.derivatives, generalised);
    std::array<ComplexMatrix, nodes> moved;
    Vector spin = Vector::Zero(), spin_slope = Vector::Zero();
    for (int i = 0; i < nodes; ++i) {
      const Vector nodal_spin = this->samples_.of_length(1.0);
      moved[i] = spun(rotations[i], nodal_spin);
      spin += generalised.values[i] * nodal_spin;
      spin_slope += generalised.derivatives[i] * nodal_spin;
    }
    const InterpolatedRotation<Complex> changed =
        LocalRotations<nodes, Complex>(moved).evaluate(shape.values, shape.derivatives);
    const double tolerance = 2 * interpolation_roundoff * slope_sum(shape);
    EXPECT_LT(distance(derivative(changed.rotation), so3::hat(spin) * section.rotation), tolerance);
    EXPECT_LT(distance(derivative(changed.curvature), section.rotation.transpose() * spin_slope), tolerance);
  });
}

TYPED_TEST(LocalRotationTest, SuperposedRotationChangesNoStrain) {
  constexpr int nodes = TypeParam::value;
  this->for_each_element([this](const NodalMatrices<nodes>& rotations, const ShapeFunctions<nodes>& shape) {
    const Matrix superposed = so3::exp(this->samples_.vector());
    NodalMatrices<nodes> turned;
    for (int i = 0; i < nodes; ++i) turned[i] = superposed * rotations[i];
    GeneralisedShapeFunctions<nodes> before, after;
    const InterpolatedRotation<> section = LocalRotationVariation<nodes>(LocalRotations<nodes>(rotations))
                                               .evaluate(shape.values, shape.derivatives, before);
    const InterpolatedRotation<> moved =
        LocalRotationVariation<nodes>(LocalRotations<nodes>(turned)).evaluate(shape.values, shape.derivatives, after);
    const double tolerance = interpolation_roundoff * slope_sum(shape);
    EXPECT_LT(distance(moved.curvature, section.curvature), tolerance);
    EXPECT_LT(distance(moved.rotation, superposed * section.rotation), tolerance);
    for (int i = 0; i < nodes; ++i) {
      EXPECT_LT(distance(after.values[i], superposed * before.values[i] * superposed.transpose()), tolerance);
      EXPECT_LT(distance(after.derivatives[i], superposed * before.derivatives[i] * superposed.transpose()), tolerance);
    }
  });
}

/// The sign of the quaternion of an element's reference frame does not matter. The signs of its nodes' quaternions
/// relative to each other do.
TYPED_TEST(LocalRotationTest, QuaternionsOfEitherSignGiveTheSame) {
  constexpr int nodes = TypeParam::value;
  const NodalMatrices<nodes> rotations = nodal_rotations<nodes>(this->samples_, 0.5);
  const LocalRotations<nodes> expected(rotations);
  for (const int sign : {-1, 1}) {
    std::array<QuaternionT<double>, nodes> quaternions;
    for (int i = 0; i < nodes; ++i) {
      quaternions[i] = so3::quaternion_from_matrix(rotations[i]);
      if (i > 0)
        quaternions[i] = so3::nearer_of_two(quaternions[i], quaternions[i - 1]);
      else
        quaternions[i].coeffs() *= sign;
    }
    const LocalRotations<nodes> local(quaternions);
    EXPECT_LT(distance(local.reference_rotation(), expected.reference_rotation()), interpolation_roundoff);
    EXPECT_LT(distance(local.quarter_tangent(), expected.quarter_tangent()), interpolation_roundoff);
    for (int i = 0; i < nodes; ++i)
      EXPECT_LT(distance(local.rotation_vectors()[i], expected.rotation_vectors()[i]), interpolation_roundoff);
  }
}

/// A helix or a roll-up: rotations about one axis that is fixed in space and in the section. The strains are exact for
/// any angle between the nodes, as long as the reference nodes are less than half a turn apart.
TYPED_TEST(LocalRotationTest, UniformCurvatureIsExact) {
  constexpr int nodes = TypeParam::value;
  const Matrix start = so3::exp(this->samples_.vector());
  for (const double total : {1e-9, 0.1, 1.0, 3.0}) {
    const Vector curvature = 0.5 * this->samples_.of_length(total);
    NodalMatrices<nodes> rotations;
    for (int i = 0; i < nodes; ++i) rotations[i] = start * so3::exp(node_coordinate<nodes>(i) * curvature);
    const LocalRotations<nodes> local(rotations);
    for (const double xi : {-0.9, -0.2, 0.6}) {
      const ShapeFunctions<nodes> shape = lagrange<nodes>(xi);
      const InterpolatedRotation<> section = local.evaluate(shape.values, shape.derivatives);
      EXPECT_LT(distance(section.curvature, curvature), interpolation_roundoff * slope_sum(shape));
      EXPECT_LT(distance(section.rotation, start * so3::exp(xi * curvature)),
                interpolation_roundoff * slope_sum(shape));
    }
  }
}

TEST(ReferenceNodes, AreTheMiddleOnes) {
  EXPECT_EQ(reference_nodes<2>().first, 0);
  EXPECT_EQ(reference_nodes<2>().second, 1);
  EXPECT_EQ(reference_nodes<3>().first, 1);
  EXPECT_EQ(reference_nodes<3>().second, 1);
  EXPECT_EQ(reference_nodes<4>().first, 1);
  EXPECT_EQ(reference_nodes<4>().second, 2);
  EXPECT_EQ(reference_nodes<5>().first, 2);
  EXPECT_EQ(reference_nodes<5>().second, 2);
}

}  // namespace
}  // namespace flexarm::test
