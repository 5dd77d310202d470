// When Newton's method makes new factors.
#include "integrators/factor_reuse.h"

#include <gtest/gtest.h>

namespace flexarm {
namespace {

/// A solve whose kept factors contract by `rate`, new ones by `rate` squared; iterations with new factors.
int solve(FactorReuse& reuse, double rate, int iterations = 5) {
  int made = 0;
  bool factorise = reuse.begin(true);
  for (int i = 0; i < iterations; ++i) {
    made += factorise;
    factorise = reuse.renew(i, !factorise, i > 0, factorise ? rate * rate : rate);
  }
  return made;
}

TEST(FactorReuse, FirstSolveMakesFactors) {
  FactorReuse reuse(2);
  EXPECT_TRUE(reuse.begin(false));
  reuse.reset();
  EXPECT_FALSE(reuse.begin(true)) << "factors that hold are tried first";
}

TEST(FactorReuse, SlowContractionAsksForNewFactorsInTheNextSolves) {
  FactorReuse reuse(2);
  EXPECT_EQ(solve(reuse, 1e-6), 0);
  EXPECT_GT(solve(reuse, 0.1), 0);
  EXPECT_TRUE(reuse.begin(true));
}

TEST(FactorReuse, FastContractionGoesBackToKeptOnes) {
  FactorReuse reuse(2);
  for (int k = 0; k < 3; ++k) solve(reuse, 0.1);
  for (int k = 0; k < 4; ++k) solve(reuse, 1e-9);
  EXPECT_EQ(solve(reuse, 1e-9), 0);
}

// New factors pay at a contraction at which dear ones do not.
TEST(FactorReuse, CheapFactorsAreMadeMoreOften) {
  FactorReuse cheap(2), dear(5);
  int made_cheap = 0, made_dear = 0;
  for (int k = 0; k < 10; ++k) {
    made_cheap += solve(cheap, 1e-2);
    made_dear += solve(dear, 1e-2);
  }
  EXPECT_GT(made_cheap, made_dear);
}

// Solves that end before any factors are kept say nothing about them: now and then kept ones are tried.
TEST(FactorReuse, TriesKeptFactorsAfterSolvesWithout) {
  FactorReuse reuse(2);
  for (int k = 0; k < 3; ++k) solve(reuse, 0.1);
  const int before = solve(reuse, 0.1, 2);
  EXPECT_EQ(before, 2);
  int least = before;
  for (int k = 0; k < 20; ++k) least = std::min(least, solve(reuse, 1e-3, 2));
  EXPECT_LT(least, before);
}

}  // namespace
}  // namespace flexarm
