// Tests means of prestrains over steps against integrals by hand.
#include "model/prestrain.h"

#include <cmath>

#include <gtest/gtest.h>

#include "model/model.h"

namespace flexarm {
namespace {

TEST(MeanPrestrain, IsTheIntegralOfEachStrain) {
  Model model;
  for (const char* text : {"t < sqrt(0.1) ? 3 : -3", "0:0 1:2 2:-2", "t^2", "7"})
    model.histories.push_back(TimeFunction::parse(text));
  // Axial strain and bending about y jump, torsion is a table, shear in z is a parabola, bending about z is a number.
  model.prestrains.push_back({{0, -1, 2, 1, 0, 3}, Vector3::Zero()});
  const double begin = 0.25, end = 1.5, width = end - begin, jump = std::sqrt(0.1);
  const double jumping = 3 * (jump - begin) - 3 * (end - jump);
  // 2 t until 1, then 2 - 4 (t - 1).
  const double table = (1 - begin * begin) + (2 * 0.5 - 2 * 0.25),
               parabola = (std::pow(end, 3) - std::pow(begin, 3)) / 3;
  Vector6 expected;
  expected << jumping, 0, parabola, table, jumping, 7 * width;
  EXPECT_LT((mean_prestrain(model, 0, begin, end) - expected / width).norm(), 1e-12);
  EXPECT_EQ(mean_prestrain(model, 0, 0.4, 0.4), prestrain_at(model, 0, 0.4));
  EXPECT_EQ(mean_prestrain(model, -1, begin, end), Vector6(Vector6::Zero()));
}

// Strains of the centroid are those of the reference line minus c x K. This is linear, and so is the mean.
TEST(MeanPrestrain, IsAboutTheCentroid) {
  Model model;
  for (const char* text : {"t < 0.3 ? 1 : 2", "0:0 1:4"}) model.histories.push_back(TimeFunction::parse(text));
  const Vector3 centroid(0, 0.05, -0.08);
  model.prestrains.push_back({{0, -1, -1, -1, -1, 1}, centroid});
  const double axial = (0.3 + 2 * 0.7), bending = 2;
  Vector6 expected = Vector6::Zero();
  expected[0] = axial;
  expected[5] = bending;
  expected.head<3>() -= centroid.cross(Vector3(0, 0, bending));
  EXPECT_LT((mean_prestrain(model, 0, 0, 1) - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace flexarm
