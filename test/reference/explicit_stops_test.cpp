// Tests stops under explicit schemes: hits keep the order of the method, whose steps end where stops are touched and
// left.
#include <cmath>

#include "reference/explicit_runs.h"

namespace flexarm::test {
namespace {

constexpr double kLimit = 0.5, kSlidingMass = 2, kHitSpeed = 1.3, kContactTime = 0.2;

/// A mass on a rail between stops.
SceneBuilder carriage() {
  SceneBuilder b;
  b.body("block", kSlidingMass, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX()).limits =
      scene::JointLimits{-kLimit, kLimit};
  b.scene.gravity.setZero();
  b.scene.contact_time = kContactTime;
  b.scene.initial_joints.push_back({"rail", 0, kHitSpeed, {}, true});
  return b;
}

/// The law of docs/notes/stops.md 2 through one hit that begins at p = 0 with the speed `v`: Q = x' (k x + c p') until
/// it vanishes, by the classical Runge-Kutta method in steps that are far shorter than those of the tests.
struct Hit {
  double duration, depth, speed;  ///< at its end
};
Hit hit(double v) {
  const double give = 0.1 * 2 * kLimit, omega = std::acos(-1) / kContactTime, ratio = 0.497239;
  struct Point {
    double p, v;
  };
  const auto acceleration = [&](const Point& at) {
    const double s = at.p / give, a = 1 - s * s, x = at.p / (a * a), slope = (1 + 3 * s * s) / (a * a * a);
    return -slope * (omega * omega * x + 2 * ratio * omega * at.v);
  };
  const auto after = [&](const Point& at, double h) {
    const auto moved = [&](const Point& by, double part) {
      return Point{at.p + part * h * by.p, at.v + part * h * by.v};
    };
    const auto rate = [&](const Point& q) { return Point{q.v, acceleration(q)}; };
    const Point a = rate(at), b = rate(moved(a, 0.5)), c = rate(moved(b, 0.5)), d = rate(moved(c, 1));
    return Point{at.p + h / 6 * (a.p + 2 * b.p + 2 * c.p + d.p), at.v + h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v)};
  };
  Point now{0, v};
  double time = 0;
  for (double h = 1e-5 * kContactTime; h > 1e-17;) {
    const Point next = after(now, h);
    if (acceleration(next) < 0)
      now = next, time += h;
    else
      h /= 2;
  }
  return {time, now.p, -now.v};
}

/// Position and velocity of the mass after its first two hits.
Eigen::Vector2d carriage_at(double time) {
  const Hit first = hit(kHitSpeed), second = hit(first.speed);
  const double release = kLimit / kHitSpeed + first.duration;
  const double touch = release + (2 * kLimit + first.depth) / first.speed, left = touch + second.duration;
  EXPECT_GT(time, left);
  return {-kLimit - second.depth + second.speed * (time - left), second.speed};
}

class ExplicitStops : public ExplicitRuns {
 protected:
  Simulation after(double end, int steps) const {
    Simulation s(carriage().scene, options(GetParam().name, end / steps, 1e-12));
    run(s, steps);
    return s;
  }
};

TEST_P(ExplicitStops, HitsKeepTheOrder) {
  const double end = 4;
  const Eigen::Vector2d expected = carriage_at(end);
  double errors[2];
  for (const int k : {0, 1}) {
    const Simulation s = after(end, static_cast<int>(2 * GetParam().steps * end) << k);
    errors[k] = std::hypot(s.position(0) - expected[0], s.velocity(0) - expected[1]);
  }
  EXPECT_LT(errors[1], 1e-4);
  EXPECT_GT(errors[1], 1e-13);
  // Touches fall into different parts of the steps, so the slope is not exactly the order.
  EXPECT_GT(observed_order(errors[0], errors[1]), GetParam().order - 1) << errors[0] << " " << errors[1];
}

// The energy that dampers and releases take is in the account, with the error of the method.
TEST_P(ExplicitStops, LoseWhatTheAccountSays) {
  const double begin = 0.5 * kSlidingMass * kHitSpeed * kHitSpeed, round_off = 1e-11;
  double defects[2];
  for (const int k : {0, 1}) {
    const Simulation s = after(4, 500 << k);
    defects[k] = std::abs(energy_account(s) - begin);
    EXPECT_GT(s.energies().dissipated, 0.9 * begin);
  }
  EXPECT_LT(defects[1], std::max(defects[0] / std::pow(2, GetParam().order - 1), round_off)) << defects[0];
}

// Each piece of a step begins as the state says, so a run that is restored goes on with the same bits.
TEST_P(ExplicitStops, GoOnFromAnyState) {
  Simulation whole = without_memory(carriage()), other = without_memory(carriage());
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(whole.step().converged);
    other.restore(whole.snapshot());
    if (i % 3 == 0) continue;
    ASSERT_TRUE(whole.step().converged);
    ASSERT_TRUE(other.step().converged);
    EXPECT_EQ(whole.position(0), other.position(0)) << i;
    EXPECT_EQ(whole.velocity(0), other.velocity(0)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitStops, kExplicitMethods, method_name);

}  // namespace
}  // namespace flexarm::test
