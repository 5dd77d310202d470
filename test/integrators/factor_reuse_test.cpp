// Tests when FactorReuse lets Newton's method factorise the tangent anew, on a model of how errors decrease.
#include "integrators/factor_reuse.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

constexpr double kGuess = 1e-5, kTarget = 1e-15;

/// How the error of a model system decreases: contraction by factors of an earlier solve, and by the factors of this
/// solve's first iteration.
struct Contractions {
  double old, own;
};

struct Solve {
  int iterations = 0, factorisations = 0;
  double cost(double cost_of_factors) const { return iterations + (cost_of_factors - 1) * factorisations; }
};

/// Simulates a solve whose guess has the error kGuess. An update with new factors squares the error; from then on, the
/// kept factors contract by the square root of that error.
Solve solve(FactorReuse& reuse, const Contractions& contractions) {
  Solve solve;
  double error = kGuess, rate = contractions.old;
  bool factorise = reuse.begin(true);
  for (double last = 0; error > kTarget && solve.iterations < 50; ++solve.iterations) {
    const double update = error;
    if (factorise) {
      ++solve.factorisations;
      rate = solve.iterations == 0 ? contractions.own : error;
      error *= error;
    } else {
      error *= rate;
    }
    const UpdateOutlook outlook{update, last > 0 && !factorise ? update / last : 0.0, factorise, kTarget};
    last = factorise ? 0 : update;
    factorise = reuse.renew(solve.iterations + 1, outlook);
  }
  reuse.end(solve.iterations, solve.factorisations, error <= kTarget);
  return solve;
}

double mean_cost(FactorReuse& reuse, double cost_of_factors, const Contractions& contractions, int solves) {
  double cost = 0;
  for (int k = 0; k < solves; ++k) cost += solve(reuse, contractions).cost(cost_of_factors);
  return cost / solves;
}

TEST(FactorReuse, FirstSolveMakesFactors) {
  FactorReuse reuse(2);
  EXPECT_TRUE(reuse.begin(false));
  reuse.end(3, 1, true);
  EXPECT_FALSE(reuse.begin(true)) << "factors that hold are tried soon";
  reuse.end(2, 0, true);
  reuse.reset();
  EXPECT_TRUE(reuse.begin(true));
}

// Old factors that contract well are kept. Old factors that contract badly are replaced, and so are the solve's own
// factors if they contract badly.
TEST(FactorReuse, FindsTheCheapestPlan) {
  struct Case {
    const char* what;
    Contractions contractions;
    double cost;  // of the cheapest plan, with factors of cost 3
  };
  for (const Case& c : {Case{"old factors do", {1e-4, 1e-4}, 3}, Case{"new ones once", {0.5, 1e-4}, 3 + 2},
                        Case{"new ones twice", {0.5, 0.5}, 3 + 3}}) {
    SCOPED_TRACE(c.what);
    FactorReuse reuse(3);
    mean_cost(reuse, 3, c.contractions, 20);
    // Allowance: trials of other plans cost 1/64 of the cheapest plan. Another 1/64 covers where the counting begins
    // and ends.
    EXPECT_LE(mean_cost(reuse, 3, c.contractions, 1000), c.cost * (1 + 2.0 / 64));
  }
}

TEST(FactorReuse, FollowsWhenAnotherPlanBecomesTheCheapest) {
  const Contractions slow{0.5, 1e-4}, fast{1e-4, 1e-4};
  FactorReuse reuse(3);
  mean_cost(reuse, 3, slow, 200);
  // Trials without new factors cost at most four times the cheapest plan, an excess of three. So the next trial comes
  // after at most 64 x 3 solves.
  mean_cost(reuse, 3, fast, 2 * 64 * 3);
  EXPECT_LE(mean_cost(reuse, 3, fast, 100), 3 * (1 + 2.0 / 64));
  // The change is found without a wait if the plan in use becomes expensive.
  mean_cost(reuse, 3, slow, 10);
  EXPECT_LE(mean_cost(reuse, 3, slow, 300), 5 * (1 + 2.0 / 64));
}

// At the same contraction, new factors pay if they are cheap, and do not pay if they are expensive.
TEST(FactorReuse, CheapFactorsAreMadeMoreOften) {
  const UpdateOutlook kept{1e-7, 1e-2, false, kTarget};
  EXPECT_TRUE(FactorReuse(1.5).renew(3, kept));
  EXPECT_FALSE(FactorReuse(5).renew(3, kept));
}

TEST(FactorReuse, NewFactorsAreNotMadeForTheLastDigits) {
  const double rate = 0.05;
  EXPECT_TRUE(FactorReuse(3).renew(3, {1e-6, rate, false, kTarget}));
  EXPECT_FALSE(FactorReuse(3).renew(3, {1e-12, rate, false, kTarget}));
  EXPECT_FALSE(FactorReuse(3).renew(3, {1e-15, rate, false, kTarget}));
  EXPECT_TRUE(FactorReuse(3).renew(3, {1e-12, 2.0, false, kTarget})) << "kept ones make it worse";
}

// New factors are worth keeping only if they were computed near the solution.
TEST(FactorReuse, GoesOnWithNewFactorsFarFromTheSolution) {
  EXPECT_TRUE(FactorReuse(3).renew(3, {0.1, 0, true, kTarget}));
  EXPECT_FALSE(FactorReuse(3).renew(3, {1e-5, 0, true, kTarget}));
}

// If a plan makes a solve fail, the cost of the repeated solve counts for the plan, too. It is not tried again soon.
TEST(FactorReuse, HeedsFailures) {
  FactorReuse reuse(2);
  reuse.begin(false);
  reuse.end(5, 1, true);
  ASSERT_FALSE(reuse.begin(true)) << "a trial";
  reuse.end(2, 0, false);
  ASSERT_TRUE(reuse.begin(false));
  reuse.end(5, 1, true);
  for (int k = 0; k < 16; ++k) {
    EXPECT_TRUE(reuse.begin(true));
    reuse.end(5, 1, true);
  }
}

// Without its failures, this plan would be the cheapest. The cost of the repeated solve makes it expensive, and its
// trials rare.
TEST(FactorReuse, FailuresCostWhatFollowsThem) {
  FactorReuse reuse(2);
  int failures = 0;
  for (int k = 0; k < 1000; ++k) {
    if (reuse.begin(k > 0)) {
      reuse.end(5, 1, true);
    } else {
      ++failures;
      reuse.end(2, 0, false);
      reuse.end(20, 10, true);  // the repeated solve after the failure, without a plan
    }
  }
  // A failure costs 2 + 30 iterations instead of 6. So there is one trial in 64 x 26 / 6 = 277 solves, and one more to
  // learn the cost.
  EXPECT_LE(failures, 1 + 1000 / 277);
}

// If kept factors only do harm, full Newton is found after at most as many failures as there are plans.
TEST(FactorReuse, FindsFullNewtonWhereAllElseFails) {
  FactorReuse reuse(2);
  int failures = 0;
  for (int k = 0; k < 30; ++k) {
    int made = reuse.begin(k > 0);
    while (made > 0 && made < 4 && reuse.renew(made, {1e-5, 0, true, kTarget})) ++made;
    if (made == 4) {
      reuse.end(4, 4, true);
    } else {
      ++failures;
      reuse.end(made + 3, made, false);
      reuse.end(4, 4, true);  // the repeated solve after the failure, without a plan
    }
  }
  // The limit is twice the number of plans: as many failed trials are allowed, which may come right away.
  EXPECT_LE(failures, 6);
}

}  // namespace
}  // namespace flexarm
