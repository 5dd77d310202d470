/// Tests plane statics: the elastica (case S2), Geradin's cantilever (S6), and beams in the linear range (S13).

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "math/so3.h"
#include "reference_cantilever.h"
#include "reference_shooting.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

// ---------------------------------------------------------------- large displacements

/// Inextensible, without shear, load P L^2 / EI, by mesh-free shooting with the relative tolerance 1e-12 (the elliptic
/// integrals).
struct ElasticaRow {
  double load, transverse, shortening, slope;
};
constexpr ElasticaRow kElastica[] = {
    {0.2, 0.0663644821, 0.0026465483, 0.0996361630}, {0.5, 0.1621435757, 0.0159189625, 0.2445336471},
    {1, 0.3017207738, 0.0564332363, 0.4613519497},   {2, 0.4934574804, 0.1606417208, 0.7817498316},
    {4, 0.6699641813, 0.3289412422, 1.1212393475},   {10, 0.8106090249, 0.5549955978, 1.4302855388},
};

scene::DirectSection elastica_section() {
  return section(1e8, 1e8, 1, 1, 1, 1, 1);
}

Cantilever elastica(double load) {
  Cantilever cantilever;
  cantilever.pieces = {line({1, 0, 0})};
  cantilever.section = elastica_section();
  cantilever.force = {0, load, 0};
  return cantilever;
}

// Axial and shear stiffness of 1e8 EI / L^2 stand for infinity. They move the tip by about 1e-8 times the load.
TEST(Elastica, TipAgreesWithTheEllipticIntegrals) {
  const int elements[] = {0, 0, 96, 24, 12};
  for (int order = 2; order <= 4; ++order) {
    for (const ElasticaRow& row : kElastica) {
      const Pose tip = static_tip(elastica(row.load), elements[order], order, 4);
      const double slope = so3::log(tip.orientation).z();
      EXPECT_NEAR(tip.position.y(), row.transverse, 1e-7) << "order " << order << ", load " << row.load;
      EXPECT_NEAR(1 - tip.position.x(), row.shortening, 1e-7) << "order " << order << ", load " << row.load;
      EXPECT_NEAR(slope, row.slope, 1e-7) << "order " << order << ", load " << row.load;
    }
  }
}

TEST(Elastica, ErrorFallsWithOrderTwoP) {
  const Cantilever cantilever = elastica(10);
  const Vector3 exact = shooting_tip(cantilever, stiffness_matrix(elastica_section())).position;
  const int coarsest[] = {0, 16, 12, 8};
  for (int order = 1; order <= 3; ++order) {
    double errors[2];
    for (int k = 0; k < 2; ++k)
      errors[k] = (static_tip(cantilever, coarsest[order] << k, order, 4).position - exact).norm();
    EXPECT_NEAR(observed_order(errors[0], errors[1]), 2 * order, kOrderTolerance) << "order " << order;
  }
}

/// Published tip (Simpson and Palacios 2013): drop 2.159, shortening 0.596, rotation 0.6720. The reference values below
/// are by mesh-free shooting with the relative tolerance 1e-12.
Cantilever geradin() {
  Cantilever cantilever;
  cantilever.pieces = {line({5, 0, 0})};
  cantilever.section = section(4.8e8, 3.231e8, 1e6, 9.346e6, 1, 1, 1);
  cantilever.force = {0, 0, -600e3};
  return cantilever;
}

TEST(GeradinCantilever, TipAgreesWithTheMeshFreeSolution) {
  const int elements[] = {0, 2000, 32, 8, 4};
  for (int order = 1; order <= 4; ++order) {
    const Pose tip = static_tip(geradin(), elements[order], order);
    EXPECT_NEAR(tip.position.x() - 5, -0.5964712722, 1e-6) << "order " << order;
    EXPECT_NEAR(tip.position.z(), -2.1596938945, 1e-6) << "order " << order;
    EXPECT_NEAR(so3::log(tip.orientation).y(), 0.6720060638, 1e-6) << "order " << order;
  }
}

TEST(GeradinCantilever, ErrorFallsWithOrderTwoP) {
  const int coarsest[] = {0, 16, 4, 2};
  for (int order = 1; order <= 3; ++order) {
    double errors[2];
    for (int k = 0; k < 2; ++k) {
      const Vector3 tip = static_tip(geradin(), coarsest[order] << k, order).position;
      errors[k] = (tip - Vector3(5 - 0.5964712722, 0, -2.1596938945)).norm();
    }
    EXPECT_NEAR(observed_order(errors[0], errors[1]), 2 * order, kOrderTolerance) << "order " << order;
  }
}

// ---------------------------------------------------------------- the linear range

// Loads are so small that the relative error of linear theory, the square of the slope, is below 1e-12.
constexpr double kRelative = 1e-10;

TEST(LinearBeams, TimoshenkoTip) {
  const double length = 0.4, young = 20.02e10, shear = young * 0.38, force = -2e-3;
  const double area = 12e-3 * 25e-3, ei = young * 12e-3 * std::pow(25e-3, 3) / 12, kga = 5.0 / 6 * shear * area;
  Cantilever cantilever;
  cantilever.pieces = {line({length, 0, 0})};
  cantilever.section = section(young * area, kga, 1e3, ei, 1, 1, 1);
  cantilever.force = {0, 0, force};
  const double exact = force * std::pow(length, 3) / (3 * ei) + force * length / kga;
  // The deflection is cubic. From order 2 on, the Gauss points integrate its slope exactly.
  for (int order = 2; order <= 4; ++order)
    EXPECT_NEAR(static_tip(cantilever, 3, order).position.z(), exact, kRelative * std::abs(exact));
}

TEST(LinearBeams, TorsionAndTensionAreExactAtAnySize) {
  const double length = 2, ea = 50, gj = 3, torque = 2, force = 4;
  for (int order = 1; order <= 4; ++order) {
    Cantilever cantilever;
    cantilever.pieces = {line({length, 0, 0})};
    cantilever.section = section(ea, 20, gj, 7, 1, 1, 1);
    cantilever.force = {force, 0, 0};
    EXPECT_NEAR(static_tip(cantilever, 3, order).position.x() - length, force * length / ea, kRelative);
    cantilever.force.setZero();
    cantilever.moment = {torque, 0, 0};
    EXPECT_NEAR(so3::log(static_tip(cantilever, 3, order).orientation).x(), torque * length / gj, kRelative);
  }
}

// Three links in a row; only the middle one carries the load.
TEST(LinearBeams, LoadOnAPartOfTheSpan) {
  const double ei = 1e9, ga = 1e10, load = 1e3, a = 0.3, b = 0.7, length = 1;
  for (int order = 3; order <= 4; ++order) {
    SceneBuilder builder;
    const scene::DirectSection s = section(1e10, ga, 1e9, ei, 1, 1, 1);
    builder.beam("root", {{a, 0, 0}}, s, 2, order);
    builder.beam("middle", {{b - a, 0, 0}}, s, 2, order);
    builder.beam("tip", {{length - b, 0, 0}}, s, 2, order);
    builder.joint("clamp", scene::JointKind::Fixed, "world", "root");
    builder.joint("first_weld", scene::JointKind::Fixed, "root", "middle", {a, 0, 0});
    builder.joint("second_weld", scene::JointKind::Fixed, "middle", "tip", {b - a, 0, 0});
    builder.scene.distributed_loads.push_back(
        {"middle", {0, 0, -load}, scene::LoadFrame::World, TimeFunction::parse("1"), {}});
    builder.probe("tip", "tip", {length - b, 0, 0});
    Simulation simulation(builder.scene);
    ASSERT_TRUE(simulation.solve_static(1).converged);
    // A unit load at x bends the tip by x^2 (3 L - x) / 6 EI and shears it by x / GA. This is integrated over [a, b].
    const auto bending = [&](double x) { return (length * std::pow(x, 3) - std::pow(x, 4) / 4) / (6 * ei); };
    const auto shear = [&](double x) { return x * x / (2 * ga); };
    const double exact = -load * (bending(b) - bending(a) + shear(b) - shear(a));
    EXPECT_NEAR(simulation.probe(0).pose.position.z(), exact, kRelative * std::abs(exact)) << "order " << order;
  }
}

// A propped cantilever under uniform load: with the known reaction as a force, the tip does not move.
TEST(LinearBeams, ReactionOfAProppedCantilever) {
  const double ei = 1e7, ga = 1e9, load = 1, length = 1;
  const double free_tip = load * std::pow(length, 4) / (8 * ei) + load * length * length / (2 * ga);
  const double reaction = free_tip / (std::pow(length, 3) / (3 * ei) + length / ga);
  for (int order = 3; order <= 4; ++order) {
    Cantilever cantilever;
    cantilever.pieces = {line({length, 0, 0})};
    cantilever.section = section(1e10, ga, 1e7, ei, 1, 1, 1);
    cantilever.force = {0, 0, reaction};
    SceneBuilder builder = cantilever_scene(cantilever, 4, order);
    builder.scene.distributed_loads.push_back(
        {"arm", {0, 0, -load}, scene::LoadFrame::World, TimeFunction::parse("1"), {}});
    Simulation simulation(builder.scene);
    ASSERT_TRUE(simulation.solve_static(1).converged);
    EXPECT_NEAR(simulation.probe(0).pose.position.z(), 0, kRelative * free_tip) << "order " << order;
    const double tip_slope = load * std::pow(length, 3) / (6 * ei) - reaction * length * length / (2 * ei);
    EXPECT_NEAR(so3::log(simulation.probe(0).pose.orientation).y(), tip_slope, kRelative * std::abs(tip_slope));
  }
}

// ---------------------------------------------------------------- Newton's method

TEST(Statics, NewtonConvergesQuadraticallyOnALargeRotation) {
  Cantilever cantilever = geradin();
  cantilever.force = {100e3, 50e3, -900e3};
  cantilever.moment = {2e5, 1e6, 5e5};
  SceneBuilder builder = cantilever_scene(cantilever, 8, 3);
  builder.scene.integrator.tolerance = 1e-13;
  Simulation simulation(builder.scene);
  const StepResult result = simulation.solve_static(1);
  ASSERT_TRUE(result.converged);
  EXPECT_GT(so3::log(simulation.probe(0).pose.orientation).norm(), 0.8);
  const std::vector<double>& norms = update_norms_of(simulation);
  std::printf("Newton updates:");
  for (const double norm : norms) std::printf(" %.1e", norm);
  std::printf("\n");
  // Only updates in the asymptotic range and above round-off count. Errors of displacements and of carried strains are
  // alternately the larger one, so the mean exponent of two updates is taken.
  std::size_t first = norms.size();
  while (first > 0 && norms[first - 1] < 0.1) --first;
  int measured = 0;
  for (std::size_t k = first + 3; k < norms.size(); ++k) {
    if (norms[k] < 1e-13) continue;
    const double exponent = std::sqrt(std::log(norms[k] / norms[k - 1]) / std::log(norms[k - 2] / norms[k - 3]));
    std::printf("mean exponent %.2f\n", exponent);
    EXPECT_GT(exponent, 1.7);
    ++measured;
  }
  EXPECT_GE(measured, 1);
}

}  // namespace
}  // namespace flexarm::test
