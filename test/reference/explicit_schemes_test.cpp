// Tests explicit schemes: orders against closed forms, the account of energies, and what they refuse.
#include <cmath>

#include "flexarm/model/model_error.h"
#include "math/pi.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// `entries`: children of <simulation>.
Simulation simulation_of(const std::string& parts, const std::string& entries, const std::string& scheme, double step) {
  return Simulation(scene_of(robot(parts, entries)), options(scheme, step));
}

/// A link of 2 kg.
std::string link(const std::string& name, const Vector3& centre = Vector3::Zero(),
                 const Vector3& moments = {0.02, 0.03, 0.04}) {
  return body(name, 2, moments, centre);
}
const std::string kAboutY = "<axis xyz='0 1 0'/>", kDown = gravity({0, 0, -9.81});
const std::string kPendulum = link("bob", {0.5, 0, 0}) + joint("hinge", "continuous", "world", "bob", kAboutY);
const std::string kTwoLinks = link("upper", {0.3, 0, 0}) + link("fore", {0.2, 0.1, 0});

struct Method {
  const char* name;
  int order;
  double coarse;  ///< steps whose error is far above round-off, and its half
};

class ExplicitSchemes : public ::testing::TestWithParam<Method> {
 protected:
  static Simulation simulated(const std::string& parts, const std::string& entries, double step) {
    return simulation_of(parts, entries, GetParam().name, step);
  }
  /// The simulation after `count` steps to the time `end`.
  static Simulation after(const std::string& parts, const std::string& entries, double end, int count) {
    Simulation s = simulated(parts, entries, end / count);
    run(s, count);
    return s;
  }
  /// The error of angle and rate of a joint after `half` of a period [s], when it has swung from 0 by `angle`, and is
  /// at rest. `rate`: a scale of rates.
  static double error_after_swing(const std::string& parts, const std::string& entries, const char* joint, double half,
                                  int count, double angle, double rate) {
    const double start = energy_account(simulated(parts, entries, half / count));
    const Simulation s = after(parts, entries, half, count);
    EXPECT_NEAR(energy_account(s), start, 1e-3 * (1 + std::abs(s.energies().work))) << "a rough check of the account";
    const std::size_t swung = *s.find_coordinate(joint);
    return std::hypot(s.position(swung) - angle, s.velocity(swung) / rate);
  }
  /// Expects the error to fall with the order of the method when steps are halved. `error`: after a number of steps.
  /// `steps`: as many steps of Method::coarse. `round_off`: below which errors show no order.
  template <class Error>
  static void expect_order(const Error& error, double steps, double round_off) {
    const int count = static_cast<int>(std::lround(steps / GetParam().coarse));
    const double coarse = error(count), fine = error(2 * count);
    EXPECT_GT(fine, round_off);
    EXPECT_NEAR(std::log2(coarse / fine), GetParam().order, 0.4) << coarse << " " << fine;
  }
};

// A pendulum released from the horizontal comes to the other side, at rest, after half its period
// 4 K(1/2) / sqrt(m g l / J).
TEST_P(ExplicitSchemes, SwingAPendulum) {
  constexpr double kFirstKind = 1.8540746773013719184;  // K(m = 1/2)
  const double rate = std::sqrt(2 * 9.81 * 0.5 / (0.03 + 2 * 0.25)), half = 2 * kFirstKind / rate;
  const auto error = [&](int steps) {
    const Simulation s = after(kPendulum, kDown, half, steps);
    return std::hypot(s.position(0) - kPi, s.velocity(0) / rate);
  };
  expect_order(error, half, 1e-13);
}

// A pendulum on a cart that a motion accelerates by 3 m/s^2. Gravity is inclined so that the pendulum feels 9.81 m/s^2
// along -z, and swings as on a cart at rest.
TEST_P(ExplicitSchemes, SwingOnACartThatAMotionDrives) {
  constexpr double kFirstKind = 1.8540746773013719184;  // K(m = 1/2)
  const double rate = std::sqrt(2 * 9.81 * 0.5 / (0.03 + 2 * 0.25)), half = 2 * kFirstKind / rate;
  const std::string parts = link("cart") + link("bob", {0.5, 0, 0}) +
                            joint("hinge", "continuous", "cart", "bob", kAboutY) + rail("rail", "cart", "1 0 0");
  const auto error = [&](int steps) {
    return error_after_swing(parts, gravity({3, 0, -9.81}) + "<motion joint='rail' position='1.5*t*t'/>", "hinge", half,
                             steps, kPi, rate);
  };
  expect_order(error, half, 1e-13);
}

// The effort of a motion is that of the equation of motion, and its work the change of energy.
TEST_P(ExplicitSchemes, FindTheEffortOfAMotion) {
  constexpr double kStep = 0.02;
  Simulation s =
      simulated(link("wheel") + joint("hinge", "continuous", "world", "wheel", kAboutY + "<dynamics damping='0.5'/>"),
                "<motion joint='hinge' position='sin(4*t)'/>", kStep);
  const double start = energy_account(s);
  for (int n = 0; n < 20; ++n) {
    ASSERT_TRUE(s.step().converged);
    const double t = s.time();
    // Errors of the polynomial through ten samples in a step: (4 h)^8 / 8! and less; round-off 1e-16 * 100 / h^2
    EXPECT_NEAR(s.velocity(0), 4 * std::cos(4 * t), 1e-10);
    EXPECT_NEAR(s.effort(0), -0.03 * 16 * std::sin(4 * t) + 0.5 * 4 * std::cos(4 * t), 1e-9);
  }
  EXPECT_NEAR(energy_account(s), start, GetParam().order == 4 ? std::pow(4 * kStep, 4) : 1e-9);
}

// A motion whose rate jumps strikes what it carries: the wheel of a trolley that suddenly stops keeps its momentum.
TEST_P(ExplicitSchemes, TakeTheImpulsesOfMotions) {
  Simulation s = simulated(link("trolley") + link("bob", {0, 0, -0.5}) + rail("rail", "trolley", "1 0 0") +
                               joint("hinge", "continuous", "trolley", "bob", kAboutY),
                           gravity({0, 0, 0}) + "<motion joint='rail' position='t &lt; 0.5 ? t : 0.5'/>", 0.1);
  run_until(s, 1);
  // m v a = (J + m a^2) w; the hinge turns about y, from x to -z.
  EXPECT_NEAR(s.velocity(*s.find_coordinate("hinge")), -2 * 0.5 * 1 / (0.03 + 2 * 0.25), 1e-9);
  EXPECT_NEAR(energy_account(s), 0.5 * (2 + 2) * 1, 1e-9);
}

// A spring that a program applies pulls a block on a rail: a harmonic oscillator. Its work is the change of energy.
TEST_P(ExplicitSchemes, ArePulled) {
  const double rate = std::sqrt(50.0 / 2), half = kPi / rate;
  const auto error = [&](int steps) {
    Simulation s = simulated(link("block") + rail("rail", "block", "1 0 0"), "", half / steps);
    AppliedWrench spring;
    spring.link = 1;
    spring.at = {0.1, 0, 0};
    spring.pull.target = {0.5, 0, 0};
    spring.pull.stiffness = 50;
    s.apply_wrenches({spring});
    run(s, steps);
    EXPECT_NEAR(energy_account(s), 0, 1e-3);
    return std::hypot(s.position(0) - 0.8, s.velocity(0) / rate);
  };
  expect_order(error, half * rate / 3.5, 1e-14);
}

// A joint with a spring and another one that follows it: a harmonic oscillator.
TEST_P(ExplicitSchemes, FollowOtherJoints) {
  const double inertia = 0.03 + 1.5 * 1.5 * 0.04, rate = std::sqrt(7 / inertia), half = kPi / rate;
  const std::string parts = link("first") + link("second") + joint("a", "continuous", "world", "first", kAboutY) +
                            joint("b", "continuous", "world", "second",
                                  "<axis xyz='0 0 1'/><mimic joint='a' multiplier='-1.5' offset='0.2'/>") +
                            "<spring joint='a' stiffness='7' rest='0.4'/>";
  const auto error = [&](int steps) {
    const Simulation s = after(parts, "", half, steps);
    EXPECT_NEAR(s.position(1), 0.2 - 1.5 * s.position(0), 1e-14);
    EXPECT_NEAR(s.velocity(1), -1.5 * s.velocity(0), 1e-13);
    return std::hypot(s.position(0) - 0.8, s.velocity(0) / rate);
  };
  expect_order(error, half * rate / 3.5, 1e-14);
}

// A parallelogram linkage swings as a pendulum: its coupler is not turned. It is let go at 60 degrees.
TEST_P(ExplicitSchemes, SwingAParallelogram) {
  constexpr double kFirstKind = 1.6857503548125960429;  // K(m = sin^2(30 degrees))
  const double rate = std::sqrt((2 * 0.5 * 2 + 2 * 1) * 9.81 / (2 * (0.03 + 2 * 0.25) + 2)),
               half = 2 * kFirstKind / rate;
  const Vector3 centre(0.43301270189221932, 0, -0.25);
  const std::string end = "<origin xyz='" + xyz(2 * centre) + "'/>";
  const std::string parts =
      link("crank", centre) + link("coupler", {0.4, 0, 0.1}) + link("rocker", centre) +
      joint("crank", "continuous", "world", "crank", kAboutY) +
      joint("knee", "continuous", "crank", "coupler", end + kAboutY) +
      joint("foot", "continuous", "world", "rocker", "<origin xyz='0.8 0 0'/>" + kAboutY) +
      joint("hip", "continuous", "rocker", "coupler", end + "<child_origin xyz='0.8 0 0'/>" + kAboutY, "loop_joint");
  const auto error = [&](int steps) {
    return error_after_swing(parts, kDown, "crank", half, steps, 2 * kPi / 3, rate);
  };
  expect_order(error, 1.6 * half, 1e-14);
}

// The four-bar linkage of the speed report, driven: positions and efforts are those of em4 with short steps.
TEST_P(ExplicitSchemes, DriveAFourBar) {
  const scene::SceneDescription scene = scene_at("config/speed/rigid_four_bar.urdf");
  const auto end = [&](const std::string& scheme, double step) {
    Simulation s(scene, options(scheme, step));
    const double start = energy_account(s);
    run_until(s, 1);
    EXPECT_NEAR(energy_account(s), start, 1e-6);
    return s;
  };
  Simulation s = end(GetParam().name, GetParam().order == 4 ? 2e-3 : 1e-2), reference = end("em4", 1e-3);
  EXPECT_LT((s.probe_pose(0).position - reference.probe_pose(0).position).norm(), 1e-8);
  EXPECT_LT((s.probe(0).velocity - reference.probe(0).velocity).norm(), 1e-4);
  EXPECT_NEAR(s.effort(0), reference.effort(0), 1e-2 * std::abs(s.effort(0)));
}

// Velocities and accelerations of output are those of the equations at the end of the step, whatever its length.
TEST_P(ExplicitSchemes, PublishVelocitiesAndAccelerations) {
  constexpr double kInertia = 0.03 + 2 * 0.25;
  Simulation s = simulated(kPendulum, kDown + "<probe name='tip' link='bob' at='1 0 0'/>", 0.05);
  for (int n = 0; n < 12; ++n) {
    ASSERT_TRUE(s.step().converged);
    const double angle = s.position(0), rate = s.velocity(0), change = 2 * 9.81 * 0.5 * std::cos(angle) / kInertia;
    const Vector3 along(std::cos(angle), 0, -std::sin(angle)), across(-std::sin(angle), 0, -std::cos(angle));
    const ProbeAcceleration acceleration = s.probe_acceleration(0);
    EXPECT_LT((s.probe(0).velocity - rate * across).norm(), 1e-13);
    EXPECT_LT((acceleration.linear - change * across + rate * rate * along).norm(), 1e-12);
    EXPECT_LT((acceleration.angular - Vector3(0, change, 0)).norm(), 1e-12);
  }
}

// A symmetric top without loads: its axis turns about the angular momentum L with |L| / A, and it spins about the axis
// with w (A - C) / A; A, C: moments of inertia across and along the axis, w: the angular velocity along it.
TEST_P(ExplicitSchemes, SpinATop) {
  const std::string top = link("top", {0, 0, 0}, {0.3, 0.3, 0.5}) + joint("free", "floating", "world", "top"),
                    spin = gravity({0, 0, 0}) + "<initial link='top' linear='0.3 -0.2 0.1' angular='0.8 0 2'/>";
  constexpr double kTime = 4;
  const Vector3 momentum(0.3 * 0.8, 0, 0.5 * 2);
  const Quaternion turned = Quaternion(Eigen::AngleAxisd(kTime * momentum.norm() / 0.3, momentum.normalized())) *
                            Quaternion(Eigen::AngleAxisd(kTime * 2 * (0.3 - 0.5) / 0.3, Vector3::UnitZ()));
  const auto error = [&](int steps) {
    const Simulation s = after(top, spin, kTime, steps);
    const Pose pose = s.link_pose(1);
    EXPECT_LT((pose.position - kTime * Vector3(0.3, -0.2, 0.1)).norm(), 1e-12);
    return pose.orientation.angularDistance(turned);
  };
  expect_order(error, kTime, 1e-13);
}

// Two links with springs, dampers, smooth friction, rotors, an effort and a load: what the energy lacks is the work and
// what was dissipated, up to the error of the steps. Results are those of em4 with short steps.
TEST_P(ExplicitSchemes, KeepTheAccount) {
  const std::string parts =
      kTwoLinks + joint("shoulder", "continuous", "world", "upper", kAboutY + "<dynamics damping='0.3'/>") +
      joint("elbow", "prismatic", "upper", "fore",
            "<axis xyz='1 0 0'/><origin xyz='0.6 0 0' rpy='0.3 0 0.2'/><dynamics damping='1'/>" + kFarLimits) +
      "<spring joint='elbow' stiffness='60' rest='0.1'/> <drive joint='shoulder' rotor_inertia='0.1'/>";
  const std::string entries = kDown +
                              "<effort joint='shoulder' history='3*sin(5*t)'/>"
                              "<load link='fore' at='0.1 0 0.2' force='2 -1 3' frame='follower' history='1+t'/>";
  Simulation s = simulated(parts, entries, GetParam().order == 4 ? 2e-3 : 1e-2),
             reference = simulation_of(parts, entries, "em4", 1e-3);
  const double start = energy_account(s);
  run_until(s, 1, [&] { EXPECT_NEAR(energy_account(s), start, 1e-6); });  // energies of 10 J
  run_until(reference, 1);
  EXPECT_GT(s.energies().dissipated, 0.1);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(s.position(i), reference.position(i), 1e-6);
    EXPECT_NEAR(s.velocity(i), reference.velocity(i), 1e-4);
    EXPECT_NEAR(s.effort(i), reference.effort(i), 1e-2);  // em4's is the mean over its last step
  }
  EXPECT_NEAR(s.energies().dissipated, reference.energies().dissipated, 1e-5);
  EXPECT_NEAR(s.energies().work, reference.energies().work, 1e-5);
}

TEST_P(ExplicitSchemes, GoOnFromARestoredStateBitByBit) {
  const std::string parts = kTwoLinks + joint("shoulder", "continuous", "world", "upper", "<axis xyz='0 0.6 0.8'/>") +
                            joint("ball", "spherical", "upper", "fore", "<origin xyz='0.6 0 0'/>");
  Simulation s(scene_of(robot(parts, kDown)), full_newton(options(GetParam().name)));
  run(s, 7);
  const Snapshot middle = s.snapshot();
  run(s, 9);
  const Pose end = s.link_pose(2);
  s.restore(middle);
  run(s, 9);
  EXPECT_EQ(s.link_pose(2).position, end.position);
  EXPECT_EQ(s.link_pose(2).orientation.coeffs(), end.orientation.coeffs());
}

// What a step had computed when it failed is not used by later ones.
TEST_P(ExplicitSchemes, GoOnAfterAFailure) {
  Simulation s =
      simulated(link("arm", {0.3, 0, 0}) + joint("hinge", "revolute", "world", "arm",
                                                 kAboutY + "<limit lower='-3' upper='3' effort='100' velocity='9'/>"),
                "<load link='arm' at='1 0 0' force='0 0 1' history='t &lt; 0.55 ? 1 : sqrt(-1)'/>", 0.1);
  run(s, 5);
  EXPECT_FALSE(s.step().converged);
  EXPECT_GT(s.time(), 0.54);  // sub-steps went on after the first one had failed
  EXPECT_LE(s.time(), 0.55);
  EXPECT_TRUE(std::isfinite(s.energies().total()));
}

// A scene with something that explicit schemes do not have is refused by name.
TEST_P(ExplicitSchemes, RefuseWhatTheyDoNotHave) {
  const auto refused = [&](const std::string& of_joint, const std::string& more = "") {
    return refusal<ModelError>([&] {
      simulated(link("arm", {0.3, 0, 0}) + joint("hinge", "continuous", "world", "arm", of_joint) + more, "", 1e-3);
    });
  };
  EXPECT_EQ(refused(""), "");
  EXPECT_EQ(refused("", "<drive joint='hinge' rotor_inertia='0.1' stiffness='900'/>"), "");
  const std::string none = std::string("scheme '") + GetParam().name + "' has no ";
  expect_contains(refused("", "<drive joint='hinge' rotor_inertia='0.1' efficiency='0.9'/>"),
                  none + "losses of rigid gears");
  expect_contains(refused("<dynamics friction='1'/><friction law='coulomb'/>"), none + "dry friction");
  expect_contains(refused("", R"(<spring name="coil" stiffness="1" rest_length="1" from="world" from_at="1 1 0" to="arm"
      to_at="0 0 1"/>)"),
                  none + "springs, lines, drag or contacts");
  expect_contains(refused("", joint("glue", "fixed", "arm", "rod") + R"(<link name="rod"><beam elements="1"><centerline>
      <line to="1 0 0"/></centerline><section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3"
      j2="5e-4" j3="5e-4"/></beam></link>)"),
                  none + "flexible links");
}

// A block is pushed by P against its motion, and rubs with F tanh(v/s), which reverses within a fiftieth of a step.
// With G(v) = P v - F s ln(P cosh(v/s) + F sinh(v/s)) the time to the rate v is m (G(start) - G(v)) / (P^2 - F^2).
TEST_P(ExplicitSchemes, ReverseSmoothFriction) {
  constexpr double kMass = 2, kPush = 5, kFriction = 2, kSpeed = 1e-3, kStart = 1, kStep = 0.02;
  const auto primitive = [](double v) {
    const double u = std::abs(v) / kSpeed, sign = v < 0 ? -1 : 1;
    const double log_sum =
        u + std::log(0.5 * (kPush + sign * kFriction) + 0.5 * (kPush - sign * kFriction) * std::exp(-2 * u));
    return kPush * v - kFriction * kSpeed * log_sum;
  };
  Simulation simulation =
      simulated(link("block") + joint("rail", "prismatic", "world", "block",
                                      "<axis xyz='1 0 0'/><dynamics friction='2'/>" + kFarLimits),
                gravity({0, 0, 0}) + "<initial joint='rail' velocity='1'/><effort joint='rail' history='-5'/>", kStep);
  run_until(simulation, 0.8);
  const double v = simulation.velocity(0);
  ASSERT_LT(v, -0.5);
  const double time = kMass * (primitive(kStart) - primitive(v)) / (kPush * kPush - kFriction * kFriction);
  EXPECT_NEAR(time, simulation.time(), 0.01 * kSpeed * kMass / kFriction)
      << "a hundredth of the time that it reverses in";
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitSchemes, ::testing::Values(Method{"rk4", 4, 0.05}, Method{"dop853", 8, 0.25}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm::test
