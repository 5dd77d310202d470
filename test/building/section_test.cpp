// Tests cross-sections against handbook values and independent formulas.
#include "building/section.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;

const scene::Material kSteel{2.1e11, 0.3, 7850};
const double kShearModulus = 2.1e11 / 2.6;

SectionProperties of(const scene::SectionShape& shape) {
  return section_properties(scene::GeometricSection{shape, kSteel});
}
/// Shear correction factor along section axis 1 (y) or 2 (z).
double shear_factor(const SectionProperties& s, int axis) {
  return s.stiffness(axis, axis) / kShearModulus * 2.1e11 / s.stiffness(0, 0);
}

void expect_diagonal(const SectionProperties& s) {
  EXPECT_EQ(largest(s.stiffness - Matrix6(s.stiffness.diagonal().asDiagonal())), 0);
  EXPECT_EQ(largest(s.inertia - Matrix3(s.inertia.diagonal().asDiagonal())), 0);
  EXPECT_TRUE(s.center_of_mass.isZero(0));
  // The polar second moment is the sum of the other two, for stiffness and inertia.
  EXPECT_NEAR(s.inertia(0, 0), s.inertia(1, 1) + s.inertia(2, 2), 1e-12 * s.inertia(0, 0));
  EXPECT_NEAR(s.inertia(1, 1) / s.stiffness(4, 4), 7850 / 2.1e11, 1e-12 * 7850 / 2.1e11);
}

TEST(Section, Circle) {
  const SectionProperties s = of(scene::Circle{0.02});
  expect_diagonal(s);
  const double area = kPi * 0.02 * 0.02, second = kPi * std::pow(0.04, 4) / 64;
  EXPECT_NEAR(s.stiffness(0, 0), 2.1e11 * area, 1e-3);
  EXPECT_NEAR(s.stiffness(4, 4), 2.1e11 * second, 1e-8);
  EXPECT_NEAR(s.stiffness(3, 3), kShearModulus * 2 * second, 1e-8);
  EXPECT_NEAR(s.mass, 7850 * area, 1e-12);
  EXPECT_NEAR(shear_factor(s, 1), 0.886, 5e-4);  // Cowper (1966), table for nu = 0.3
  EXPECT_NEAR(shear_factor(s, 2), 0.886, 5e-4);
  EXPECT_EQ(s.radius, 0.02);
}

TEST(Section, Tube) {
  const SectionProperties s = of(scene::Tube{0.05, 0.04});
  expect_diagonal(s);
  const double second = kPi * (std::pow(0.1, 4) - std::pow(0.08, 4)) / 64;
  EXPECT_NEAR(s.stiffness(0, 0), 2.1e11 * kPi * (0.05 * 0.05 - 0.04 * 0.04), 1e-3);
  EXPECT_NEAR(s.stiffness(5, 5), 2.1e11 * second, 1e-6);
  EXPECT_NEAR(s.stiffness(3, 3), kShearModulus * 2 * second, 1e-6);
  EXPECT_NEAR(shear_factor(of(scene::Tube{1.0, 0.9999}), 1), 0.531, 5e-4);  // Cowper, thin-walled, nu = 0.3
  EXPECT_NEAR(shear_factor(of(scene::Tube{1.0, 0.0}), 1), 0.886, 5e-4);     // without a hole: that of the circle
}

double torsion_constant(double width, double height) {
  return of(scene::Rectangle{width, height}).stiffness(3, 3) / kShearModulus;
}

TEST(Section, TorsionOfRectangles) {
  struct Case {
    double ratio, printed,
        digits;  // J / (a b^3) in Timoshenko and Goodier, Theory of Elasticity, art. 109; half a digit
  };
  for (const auto& [ratio, printed, digits] : {Case{1, 0.1406, 5e-5}, Case{1.2, 0.166, 5e-4}, Case{1.5, 0.196, 5e-4},
                                               Case{2, 0.229, 5e-4}, Case{2.5, 0.249, 5e-4}, Case{3, 0.263, 5e-4},
                                               Case{4, 0.281, 5e-4}, Case{5, 0.291, 5e-4}, Case{10, 0.312, 5e-4}})
    EXPECT_NEAR(torsion_constant(0.02, 0.02 * ratio) / (ratio * std::pow(0.02, 4)), printed, digits) << ratio;
  // Saint-Venant's series, summed by mpmath with 30 digits.
  const double square = 0.140577014955153715588, two_squares = 2 * 0.228681677119570765026;
  EXPECT_NEAR(torsion_constant(1, 1), square, 8e-16);
  EXPECT_NEAR(torsion_constant(1, 2), two_squares, 2e-15);
  EXPECT_NEAR(torsion_constant(10, 1), 10 * 0.312325037457205385544, 1e-14);
  EXPECT_EQ(torsion_constant(0.03, 0.07), torsion_constant(0.07, 0.03));
  EXPECT_NEAR(torsion_constant(1, 1e6), 1e6 / 3, 0.22);  // a strip: a b^3 / 3 - 0.21 b^4
}

/// Torsion constant by the other of Saint-Venant's two series, whose waves are along the long side a.
double torsion_by_other_series(double a, double b) {
  double sum = 0;
  for (int n = 19999; n > 0; n -= 2) sum += std::tanh(n * kPi * b / (2 * a)) / std::pow(n, 5);
  return b * a * a * a / 3 * (1 - 192 / std::pow(kPi, 5) * a / b * sum);
}

TEST(Section, Rectangle) {
  const SectionProperties s = of(scene::Rectangle{0.02, 0.06});
  expect_diagonal(s);
  EXPECT_NEAR(s.stiffness(4, 4), 2.1e11 * 0.02 * std::pow(0.06, 3) / 12, 1e-7);  // about y: the height counts cubed
  EXPECT_NEAR(s.stiffness(5, 5), 2.1e11 * 0.06 * std::pow(0.02, 3) / 12, 1e-7);
  EXPECT_NEAR(shear_factor(s, 1), 0.850, 5e-4);
  EXPECT_NEAR(s.radius, std::hypot(0.01, 0.03), 1e-15);
  // Round-off of the other series grows with the square of the sides' ratio: its terms cancel.
  for (const double height : {0.02, 0.0201, 0.03, 0.06, 0.2}) {
    const double exact = torsion_by_other_series(height, 0.02), cancelled = 1e-15 * std::pow(height / 0.02, 2);
    EXPECT_NEAR(torsion_constant(0.02, height), exact, 10 * cancelled * exact) << height;
  }
}

TEST(Section, BoxTube) {
  const SectionProperties s = of(scene::BoxTube{0.04, 0.08, 0.002});
  expect_diagonal(s);
  EXPECT_NEAR(s.stiffness(0, 0), 2.1e11 * (0.04 * 0.08 - 0.036 * 0.076), 1e-3);
  EXPECT_NEAR(s.stiffness(4, 4), 2.1e11 * (0.04 * std::pow(0.08, 3) - 0.036 * std::pow(0.076, 3)) / 12, 1e-6);
  EXPECT_NEAR(s.stiffness(5, 5), 2.1e11 * (0.08 * std::pow(0.04, 3) - 0.076 * std::pow(0.036, 3)) / 12, 1e-6);
  const double enclosed = 0.038 * 0.078, perimeter = 2 * (0.038 + 0.078);
  EXPECT_NEAR(s.stiffness(3, 3), kShearModulus * 4 * enclosed * enclosed * 0.002 / perimeter, 1e-6);  // Bredt

  const SectionProperties square = of(scene::BoxTube{0.1, 0.1, 1e-4});
  EXPECT_NEAR(shear_factor(square, 1), 20 * 1.3 / (48 + 39 * 0.3), 1e-12);  // Cowper, thin square tube
  EXPECT_NEAR(shear_factor(square, 1), shear_factor(square, 2), 1e-14);
  // A rotation by a quarter turn exchanges the factors. Along the long walls, more area carries the shear.
  const SectionProperties turned = of(scene::BoxTube{0.08, 0.04, 0.002});
  EXPECT_NEAR(shear_factor(s, 1), shear_factor(turned, 2), 1e-14);
  EXPECT_GT(shear_factor(s, 2), shear_factor(s, 1));
  // Without flanges, the box is a rectangle.
  EXPECT_NEAR(shear_factor(of(scene::BoxTube{0.002, 1, 0.001}), 2), 0.850, 5e-3);
}

TEST(Section, DirectStiffnesses) {
  const SectionProperties s = section_properties(scene::DirectSection{1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  for (int k = 0; k < 6; ++k) EXPECT_EQ(s.stiffness(k, k), k + 1);
  EXPECT_EQ(s.mass, 7);
  EXPECT_EQ(s.inertia.diagonal(), Vector3(8, 9, 10));
}

scene::MatrixSection matrix_section(RandomSource& random, double mass, const Vector3& center, const Matrix3& inertia) {
  scene::MatrixSection section;
  section.stiffness = random.positive_definite<6>();
  // Momenta of points of mass dm: l = int (v + w x Y) dm, and moments of momentum about the reference line.
  const Matrix3 d = so3::hat(center);
  section.inertia << mass * Matrix3::Identity(), -mass * d, mass * d, inertia - mass * d * d;
  return section;
}

TEST(Section, MatrixInertiaIsReferredToItsCentre) {
  RandomSource random(1);
  const Vector3 center(0, 0.03, -0.02);
  const Matrix3 inertia = random.positive_definite<3>();
  const SectionProperties s = section_properties(matrix_section(random, 2.5, center, inertia));
  EXPECT_NEAR(s.mass, 2.5, 1e-15);
  EXPECT_LE((s.center_of_mass - center).norm(), 1e-15);
  EXPECT_LE(largest(s.inertia - inertia), 1e-14);
}

// The strain energy of a deformed piece is the same for strains of the reference line and of the line of centroids.
TEST(Section, ReferringToTheCentroidKeepsTheStrainEnergy) {
  RandomSource random(2);
  const Vector3 center(0, 0.3, -0.2);
  const SectionProperties s = section_properties(matrix_section(random, 2.5, center, Matrix3::Identity()));
  const SectionProperties moved = referred_to_center_of_mass(s);
  EXPECT_TRUE(moved.center_of_mass.isZero(0));
  EXPECT_LE(largest(moved.stiffness - moved.stiffness.transpose()), 1e-14);
  const Quaternion start = random.rotation(2);
  const Vector3 turning = random.vector(), slope = random.vector();
  const auto rotation = [&](double arc) {
    return Matrix3((so3::exp_quaternion(Vector3(arc * turning)) * start).toRotationMatrix());
  };
  // Strain of the line through a point of the section, straight at first
  const auto strain = [&](const Vector3& in_section) {
    Vector6 out;
    const Vector3 tangent =
        difference([&](double arc) { return Vector3(arc * slope + arc * arc * turning + rotation(arc) * in_section); });
    out << rotation(0).transpose() * tangent - Vector3::UnitX(), rotation(0).transpose() * turning;
    return out;
  };
  const Vector6 at_reference = strain(Vector3::Zero()), at_center = strain(center);
  EXPECT_NEAR(at_reference.dot(s.stiffness * at_reference), at_center.dot(moved.stiffness * at_center), 1e-9);
}

// ---------------------------------------------------------------- along the line

TEST(SectionLine, UniformEverywhere) {
  const SectionLine line(scene::Section(scene::DirectSection{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  EXPECT_TRUE(line.is_uniform());
  EXPECT_TRUE(line.stations().empty());
  for (const double s : {-1.0, 0.0, 3.0}) EXPECT_EQ(line.at(s).stiffness(3, 3), 4);
}

TEST(SectionLine, ShapesChangeByTheirLengths) {
  const auto rectangle = [](double width, double height) {
    return scene::UniformSection(scene::GeometricSection{scene::Rectangle{width, height}, kSteel});
  };
  const SectionLine line(
      scene::SectionStations{{0.5, 1, 2}, {rectangle(0.1, 0.04), rectangle(0.1, 0.02), rectangle(0.2, 0.02)}});
  const auto expect = [&](double s, double width, double height) {
    const SectionProperties at = line.at(s), exact = of(scene::Rectangle{width, height});
    EXPECT_LE(largest(at.stiffness - exact.stiffness), 1e-14 * largest(exact.stiffness)) << s;
    EXPECT_LE(largest(at.inertia - exact.inertia), 1e-14 * largest(exact.inertia)) << s;
    EXPECT_NEAR(at.mass, exact.mass, 1e-14 * exact.mass) << s;
  };
  expect(0, 0.1, 0.04);  // before the first station
  expect(0.5, 0.1, 0.04);
  expect(0.75, 0.1, 0.03);
  expect(1, 0.1, 0.02);
  expect(1.25, 0.125, 0.02);
  expect(3, 0.2, 0.02);  // beyond the last station
  EXPECT_EQ(line.largest_radius(), of(scene::Rectangle{0.2, 0.02}).radius);
}

TEST(SectionLine, MatricesChangeByTheirNumbers) {
  RandomSource random(3);
  const scene::MatrixSection a = matrix_section(random, 2, Vector3(0, 0.1, 0), random.positive_definite<3>()),
                             b = matrix_section(random, 4, Vector3(0, 0.1, 0), random.positive_definite<3>());
  const SectionProperties quarter = SectionLine(scene::SectionStations{{0, 1}, {a, b}}).at(0.25);
  EXPECT_LE(largest(quarter.stiffness - (0.75 * a.stiffness + 0.25 * b.stiffness)), 1e-14 * largest(b.stiffness));
  EXPECT_NEAR(quarter.mass, 2.5, 1e-14);
  EXPECT_LE((quarter.center_of_mass - Vector3(0, 0.1, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace flexarm
