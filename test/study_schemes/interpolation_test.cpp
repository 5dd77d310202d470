// Tests the interpolated rotations of an element for all interpolations: variation and curvature.
#include "elements/kernel_checks.h"

namespace flexarm {
namespace {

using namespace test;

const InterpolationChoice kAllInterpolations[] = {{Interpolation::Local},
                                                  {Interpolation::Total},
                                                  {Interpolation::Incremental},
                                                  {Interpolation::Incremental, RotationParameters::TangentScaled},
                                                  {Interpolation::Iterative}};

template <class Count>
class ElementInterpolation : public ::testing::Test {};
TYPED_TEST_SUITE(ElementInterpolation, NodeCounts);

/// Rotation and curvature at a stiffness point.
template <int Nodes>
InterpolatedRotation<double> rotation_at(const RandomStep<Nodes>& step, const ElementNodes<Nodes>& nodes, int k,
                                         GeneralisedShapeFunctions<Nodes>& functions) {
  const auto& point = step.element.stiffness_points[k];
  return ElementRotations<Nodes>(nodes, true)
      .evaluate(point.shape, point.derivative, &step.stiffness_reference[k], functions);
}

// spin = I_g spin_i, d(curvature) = Lambda^T I_g' spin_i.
TYPED_TEST(ElementInterpolation, VariationFunctions) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(1, kAllInterpolations, [](const RandomStep<N>& step) {
    for (int k = 0; k < N - 1; ++k) {
      GeneralisedShapeFunctions<N> functions, unused;
      const InterpolatedRotation<double> point = rotation_at<N>(step, step.nodes, k, functions);
      double scale = 1;
      for (int i = 0; i < N; ++i)
        scale = std::max({scale, largest(functions.values[i]), largest(functions.derivatives[i])});
      for (int i = 0; i < N; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const int column = 6 * i + 3 + axis;
          const Matrix3 turning = difference([&](double h) {
            return Matrix3(rotation_at<N>(step, step.perturbed(column, h), k, unused).rotation *
                           point.rotation.transpose());
          });
          const Vector3 spin = functions.values[i].col(axis);
          EXPECT_LE(largest(turning - so3::hat(spin)), difference_tolerance * scale);
          const Vector3 bending = difference(
              [&](double h) { return Vector3(rotation_at<N>(step, step.perturbed(column, h), k, unused).curvature); });
          EXPECT_LE(largest(point.rotation * bending - functions.derivatives[i].col(axis)),
                    difference_tolerance * scale);
        }
    }
  });
}

// Compares the curvature with vee(Lambda^T dLambda/dx) along a parent coordinate. The reference rotation is a field
// with curvature.
TYPED_TEST(ElementInterpolation, CurvatureIsTheDerivativeOfTheRotation) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(2, kAllInterpolations, [](const RandomStep<N>& step) {
    const bool has_reference = step.interpolation != Interpolation::Local;
    const LocalRotations<N> field(has_reference ? step.reference_orientation : step.nodes.orientation);
    const ElementRotations<N> rotations(step.nodes, false);
    const auto at = [&](double x) {
      const ShapeFunctions<N> shape = lagrange<N>(x);
      const InterpolatedRotation<double> reference = field.evaluate(shape.values, shape.derivatives);
      GeneralisedShapeFunctions<N> unused;
      return rotations.evaluate(shape.values, shape.derivatives, &reference, unused);
    };
    for (const double x : {-0.9, -0.2, 0.6}) {
      const InterpolatedRotation<double> point = at(x);
      const Matrix3 slope =
          difference([&](double h) { return Matrix3(point.rotation.transpose() * at(x + h).rotation); });
      EXPECT_LE(largest(slope - so3::hat(point.curvature)), difference_tolerance * std::max(1.0, largest(slope)));
    }
  });
}

// At a node, the interpolation rotates the reference by the node's own rotation. So all interpolations agree at the
// nodes.
TYPED_TEST(ElementInterpolation, PassesThroughTheNodes) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(3, kAllInterpolations, [](const RandomStep<N>& step) {
    const bool has_reference = step.interpolation != Interpolation::Local;
    const LocalRotations<N> field(has_reference ? step.reference_orientation : step.nodes.orientation);
    const ElementRotations<N> rotations(step.nodes, false);
    for (int i = 0; i < N; ++i) {
      const ShapeFunctions<N> shape = lagrange<N>(node_coordinate<N>(i));
      const InterpolatedRotation<double> reference = field.evaluate(shape.values, shape.derivatives);
      GeneralisedShapeFunctions<N> unused;
      const InterpolatedRotation<double> point =
          rotations.evaluate(shape.values, shape.derivatives, &reference, unused);
      EXPECT_LE(largest(point.rotation - step.nodes.orientation[i].toRotationMatrix()), 1e-13);
    }
  });
}

// A common spin of all nodes rotates the point by the same spin only if the interpolation is strain-invariant, i.e.
// local.
TYPED_TEST(ElementInterpolation, OnlyTheLocalOneIsStrainInvariant) {
  constexpr int N = TypeParam::value;
  for_each_interpolation<N>(4, kAllInterpolations, [](const RandomStep<N>& step) {
    double defect = 0;
    for (int k = 0; k < N - 1; ++k) {
      GeneralisedShapeFunctions<N> functions;
      rotation_at<N>(step, step.nodes, k, functions);
      Matrix3 sum = Matrix3::Zero();
      for (int i = 0; i < N; ++i) sum += functions.derivatives[i];
      defect = std::max(defect, largest(sum));
    }
    // The iterative interpolation is invariant to first order at every iterate.
    if (step.interpolation == Interpolation::Local || step.interpolation == Interpolation::Iterative)
      EXPECT_LE(defect, 1e-12);
    else
      EXPECT_GE(defect, 1e-6);  // far above round-off
  });
}

}  // namespace
}  // namespace flexarm
