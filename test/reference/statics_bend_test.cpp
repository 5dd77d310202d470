/// Tests the 45-degree bend of Bathe and Bolourchi (case S4) against an independent shooting solution.

#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_cantilever.h"
#include "reference_shooting.h"

namespace flexarm::test {
namespace {

constexpr double kRadius = 100, kYoung = 1e7, kShear = 5e6;

/// A square section of width w with the shear area factor k and the torsion constant J = torsion w^4.
scene::DirectSection square(double width, double k, double torsion) {
  const double area = width * width, fourth = area * area;
  return section(kYoung * area, k * kShear * area, kShear * torsion * fourth, kYoung * fourth / 12, 1, 1, 1);
}

Cantilever bend(const scene::Section& section, double load) {
  Cantilever cantilever;
  cantilever.pieces = {arc({kRadius * std::sin(kPi / 4), kRadius * (1 - std::cos(kPi / 4)), 0}, {0, kRadius, 0})};
  cantilever.section = section;
  cantilever.force = {0, 0, load};
  return cantilever;
}

/// Exact Reissner-Simo solution by mesh-free shooting, relative tolerance 1e-12. The torsion constant changes the third
/// digit.
struct Row {
  const char* name;
  double shear_factor, torsion, load;
  Vector3 tip;
};

const Row kTable[] = {
    {"J = I2 + I3", 1, 1.0 / 6, 300, {58.7791224897, 22.2447809454, 40.1918916702}},
    {"J = I2 + I3", 1, 1.0 / 6, 450, {52.2385580112, 18.5081789254, 48.5029273441}},
    {"J = I2 + I3", 1, 1.0 / 6, 600, {47.1504385736, 15.6848005340, 53.4748587918}},
    {"k = 5/6", 5.0 / 6, 1.0 / 6, 300, {58.7788973300, 22.2446794267, 40.1923923323}},
    {"k = 5/6", 5.0 / 6, 1.0 / 6, 450, {52.2382618467, 18.5080648756, 48.5034915318}},
    {"k = 5/6", 5.0 / 6, 1.0 / 6, 600, {47.1500962403, 15.6846894790, 53.4754779982}},
    {"J of Saint-Venant", 1, 0.141, 300, {58.5405134471, 22.1152402234, 40.4747949187}},
    {"J of Saint-Venant", 1, 0.141, 450, {51.9747624731, 18.3720430289, 48.7009672302}},
    {"J of Saint-Venant", 1, 0.141, 600, {46.8967695969, 15.5603254042, 53.6048584572}},
};

TEST(FortyFiveDegreeBend, TipAgreesWithTheTableOnAFineMesh) {
  for (const Row& row : kTable) {
    const Cantilever cantilever = bend(square(1, row.shear_factor, row.torsion), row.load);
    const Vector3 tip = static_tip(cantilever, 16, 4).position;
    EXPECT_LT((tip - row.tip).norm(), 1e-6) << row.name << ", load " << row.load;
    // The table has ten decimals, which the shooting solution of these tests reproduces.
    const Vector3 shot = shooting_tip(cantilever, stiffness_matrix(square(1, row.shear_factor, row.torsion))).position;
    EXPECT_LT((shot - row.tip).norm(), 1e-9) << row.name << ", load " << row.load;
  }
}

TEST(FortyFiveDegreeBend, ErrorFallsWithOrderTwoP) {
  const int coarsest[] = {0, 16, 8, 4};
  for (const int row : {2, 5, 8}) {
    const Cantilever cantilever = bend(square(1, kTable[row].shear_factor, kTable[row].torsion), kTable[row].load);
    for (int order = 1; order <= 3; ++order) {
      double errors[2];
      for (int k = 0; k < 2; ++k)
        errors[k] = (static_tip(cantilever, coarsest[order] << k, order).position - kTable[row].tip).norm();
      EXPECT_NEAR(observed_order(errors[0], errors[1]), 2 * order, kOrderTolerance) << "order " << order;
    }
  }
}

// Published results scatter by 0.5 to 1 % (coarse meshes, another torsion constant).
TEST(FortyFiveDegreeBend, TipIsWithinOnePercentOfPublishedResults) {
  const Vector3 undeformed = bend(square(1, 1, 1.0 / 6), 600).tip();
  const Vector3 tip = static_tip(bend(square(1, 1, 1.0 / 6), 600), 8, 2).position;
  const Vector3 bathe = undeformed + Vector3(-23.5, -13.4, 53.4), simo(47.23, 15.79, 53.37);
  EXPECT_LT((tip - bathe).norm(), 0.01 * (bathe - undeformed).norm());
  EXPECT_LT((tip - simo).norm(), 0.01 * (simo - undeformed).norm());
}

// The bending deformation is the same at every slenderness; an element with locking would be too stiff for thin
// sections. Shear and extension contribute (width / radius)^2, which vanishes. The remaining error is the mesh error,
// equal for all.
TEST(FortyFiveDegreeBend, ErrorDoesNotGrowWithSlenderness) {
  const double slenderness[] = {1e1, 1e2, 1e3, 1e4};
  double errors[4][5];
  for (int k = 0; k < 4; ++k) {
    const double width = kRadius / slenderness[k];
    const scene::DirectSection section = square(width, 1, 1.0 / 6);
    const Cantilever cantilever = bend(section, 600 * std::pow(width, 4));
    const Vector3 exact = shooting_tip(cantilever, stiffness_matrix(section)).position;
    for (int order = 1; order <= 4; ++order)
      errors[k][order] = (static_tip(cantilever, 4, order, 4).position - exact).norm();
  }
  for (int order = 1; order <= 4; ++order)
    for (int k = 1; k < 4; ++k)
      EXPECT_NEAR(errors[k][order] / errors[0][order], 1, 5 / (slenderness[0] * slenderness[0]))
          << "order " << order << " at " << slenderness[k];
}

}  // namespace
}  // namespace flexarm::test
