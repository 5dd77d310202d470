// Tests joints with play against closed forms, against integration by scipy
// (test/elements/scripts/reference_clearance.py), and against published simulations.
#include <cmath>

#include "flexarm/model/model_error.h"
#include "reference/contact_scenes.h"
#include "support/refusal.h"

namespace flexarm::test::touching {
namespace {

const std::string kAcross = "<axis xyz='0 1 0'/>";
const std::string kLimit = "<limit effort='0' velocity='0'/>";

// ---------------------------------------------------------------- energy, free flight

/// Two bodies on loose pins, one below the other, start beside their rest position. Their hits lose no energy.
/// @param share  error of the energy that is allowed, relative to the kinetic energy at the start
void expect_energy_kept(const SimulationOptions& options, double share) {
  const std::string play = "<clearance radius='2e-3' length='0.06' stiffness='1e5' restitution='1'/>";
  for (const std::string type : {"continuous", "spherical"}) {
    const std::string own =
        type == "spherical" ? "<clearance radius='2e-3' stiffness='1e5' restitution='1'/>" : kAcross + play;
    Simulation simulation = simulation_of(
        body("one", 1, {0.01, 0.01, 0.002}, {0, 0, -0.2}) + joint("pin", type, "world", "one", own) +
            body("two", 0.5, {0.003, 0.003, 0.001}, {0, 0, -0.15}) +
            joint("knee", type, "one", "two", "<origin xyz='0 0 -0.4'/>" + own),
        "<initial link='one' linear='0.6 0.1 0' angular='0.1 -3 0.2'/><initial link='two' linear='0 0 0.2' "
        "angular='0.4 2 0'/>",
        1e-3, {0, 0, -kG}, options);
    const double begin = simulation.energies().total(), size = simulation.energies().kinetic;
    int hits = 0;
    bool was_pressed = false;
    while (hits < 100 && simulation.time() < 100) {
      ASSERT_TRUE(steps(simulation));
      const Energies energies = simulation.energies();
      hits += energies.strain > 0 && !was_pressed;
      was_pressed = energies.strain > 0;
      ASSERT_NEAR(energies.total(), begin, share * size) << type << hits;
      ASSERT_NEAR(energies.dissipated, 0, 1e-12 * size);
    }
    EXPECT_EQ(hits, 100) << type;
  }
}

// With new factors in each iteration, only round-off is left. With kept factors, which is the default, results differ
// by far less than the tolerance of Newton's method, 1e-8; compilers differ in what adds up in a hundred hits.
TEST(Clearance, ElasticHitsKeepEnergyAndMomentum) {
  expect_energy_kept(full_newton(), 1e-10);
  expect_energy_kept({}, 1e-9);
}

TEST(Clearance, FliesFreelyUntilItTouches) {
  const double play = 5e-3, touch = std::sqrt(2 * play / kG);
  Simulation simulation =
      simulation_of(body("ball", 1, {0.01, 0.01, 0.01}) +
                        joint("socket", "spherical", "world", "ball",
                              fmt::format("<clearance radius='{}' stiffness='1e9' restitution='0.5'/>", play)),
                    "", 1e-3);
  double last = 0;
  while (simulation.time() < 2 * touch) {
    ASSERT_TRUE(simulation.step().converged);
    const double time = simulation.time(), height = simulation.link_pose(1).position.z();
    if (time < touch) {
      EXPECT_NEAR(height, -0.5 * kG * time * time, 1e-12);
    }
    if (time > touch + 2e-3 && time < touch + 0.01) {  // rebounds with half of its speed, within 1 %, after 0.1 ms
      EXPECT_NEAR((height - last) / 1e-3 + kG * (time - 0.5e-3 - touch), 0.5 * kG * touch, 0.02 * kG * touch);
    }
    last = height;
  }
}

// ---------------------------------------------------------------- equilibria

double hung_height(const std::string& type, const std::string& more) {
  Simulation simulation =
      simulation_of(body("weight", 2, {0.02, 0.02, 0.01}, {0, 0, type == "prismatic" ? 0 : -0.3}) +
                        joint("pin", type, "world", "weight",
                              (type == "prismatic" ? kLimit + "<axis xyz='1 0 0'/>" : kAcross) + more),
                    "<initial joint='pin/z' position='-1e-3'/>", 1e-3);
  EXPECT_TRUE(simulation.solve_static(1).converged) << type;
  return simulation.link_pose(1).position.z();
}

// The height is lower by the play, and by the weight over the stiffness of the loaded points: one of a ball, two ends
// of a pin, four corners of a block.
TEST(Clearance, HangsLowerByThePlay) {
  const double play = 1e-3, k = 1e5, weight = 2 * kG;
  const std::string attributes = fmt::format("<clearance radius='{}' stiffness='{}' ", play, k);
  const double tolerance = 1e-9;  // tolerance of the equilibrium
  EXPECT_NEAR(hung_height("spherical", attributes + "/>"), -play - weight / k, tolerance);
  EXPECT_NEAR(hung_height("continuous", attributes + "length='0.1'/>"), -play - weight / (2 * k), tolerance);
  EXPECT_NEAR(hung_height("prismatic", attributes + "length='0.1' width='0.04'/>"), -play - weight / (4 * k),
              tolerance);
}

/// Equilibrium pose of a weightless body that a loose joint holds at its centre of mass, under a moment. It starts
/// rotated by `start` [rad].
Pose twisted(const std::string& type, const std::string& more, double moment, double start) {
  Simulation simulation = simulation_of(
      body("weight", 2, {0.02, 0.02, 0.02}) + joint("pin", type, "world", "weight", more),
      fmt::format("<load link='weight' moment='{} 0 0'/><initial joint='pin/rx' position='{}'/>", moment, start), 1e-3,
      {0, 0, 0});
  const StaticResult result = simulation.solve_static(4);
  EXPECT_TRUE(result.converged);
  return simulation.link_pose(1);
}

// A pin is held at both ends, a block at its corners. So the rotation follows from the play over these arms.
TEST(Clearance, TiltsAndTurnsByThePlay) {
  const double play = 1e-3, k = 1e6, length = 0.1, width = 0.04, moment = 2;
  const std::string pin = kAcross + fmt::format("<clearance radius='{}' stiffness='{}' length='{}'/>", play, k, length);
  const Pose tilted = twisted("continuous", pin, moment, 0);
  // Conditions: (play + F/k) = (l/2) sin a, F l cos a = M.
  const double angle = 2 * std::atan2(tilted.orientation.x(), tilted.orientation.w());
  const double force = moment / (length * std::cos(angle));
  EXPECT_NEAR(0.5 * length * std::sin(angle), play + force / k, 1e-9);

  const std::string block =
      "<axis xyz='1 0 0'/>" + kLimit +
      fmt::format("<clearance radius='{}' stiffness='{}' length='{}' width='{}'/>", play, k, length, width);
  // The start is where the corners touch: from farther away, a step of the search would rotate the block over its
  // corners.
  const Pose turned = twisted("prismatic", block, moment, 0.052);
  const double turn = 2 * std::atan2(turned.orientation.x(), turned.orientation.w());
  // Eight corners, at (w/2) (cos a + sin a) from the middle across the wall, and (w/2) (cos a - sin a) along it.
  const double each = moment / (8 * 0.5 * width * (std::cos(turn) - std::sin(turn)));
  EXPECT_NEAR(0.5 * width * (std::cos(turn) + std::sin(turn)), 0.5 * width + play + each / k, 1e-9);
}

// The weight hangs below the lower stop, so that the body does not tip over.
TEST(Clearance, PinIsStoppedAlongItsAxis) {
  const double play = 1e-3, k = 1e5;
  Simulation simulation = simulation_of(
      body("weight", 2, {0.02, 0.02, 0.02}, {0, 0, -0.2}) +
          joint("pin", "continuous", "world", "weight",
                "<axis xyz='0 0 1'/>" + fmt::format("<clearance radius='{}' stiffness='{}' length='0.1'/>", play, k)),
      "", 1e-3);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), -play - 2 * kG / k, 1e-9);
}

// A beam carries a weight by a loose ball joint. It bends as if the weight were fixed to it.
TEST(Clearance, BeamCarriesAWeightInALooseBall) {
  const auto arm_with = [](const std::string& more) {
    return simulation_of(
        "<link name='arm'><beam elements='6' order='2'><centerline><line to='1 0 0'/></centerline><circle "
        "radius='0.01'/><material young='70e9' poisson='0.3' density='2700'/></beam></link>" +
            joint("clamp", "fixed", "world", "arm") + body("weight", 2, {0.01, 0.01, 0.01}, {0, 0, -0.1}) +
            joint("hook", "spherical", "arm", "weight", "<origin xyz='1 0 0'/>" + more),
        "", 1e-3);
  };
  Simulation loose = arm_with("<clearance radius='1e-3' stiffness='1e5'/>"), tight = arm_with("");
  ASSERT_TRUE(loose.solve_static(4).converged);
  ASSERT_TRUE(tight.solve_static(4).converged);
  EXPECT_NEAR(loose.tip_pose(1).position.z(), tight.tip_pose(1).position.z(), 1e-8);
  EXPECT_NEAR(loose.link_pose(2).position.z() - loose.tip_pose(1).position.z(), -1e-3 - 2 * kG / 1e5, 1e-8);
}

// ---------------------------------------------------------------- loops

// A ball with an eccentric weight swings in a loose bearing. The bearing is first a joint of the tree, then a loop
// joint of a free body, whose link frame is rotated at the start.
TEST(Clearance, OfALoopIsThatOfTheTree) {
  const Vector3 inertia = Vector3::Constant(0.01), centre(0.2, 0, -0.1);
  const double turn = 0.7;
  const std::string pin = kAcross + "<clearance radius='1e-3' length='0.1' restitution='0.5'/>";
  Simulation tree = simulation_of(body("ball", 1, inertia, centre) + joint("pin", "continuous", "world", "ball", pin),
                                  "<initial link='ball' linear='0 0.1 0'/>", 1e-3);
  Simulation loop = simulation_of(
      body("ball", 1, inertia, Eigen::AngleAxisd(-turn, Vector3::UnitZ()) * centre) +
          joint("free", "floating", "world", "ball") + joint("pin", "continuous", "world", "ball", pin, "loop_joint"),
      fmt::format("<initial joint='free/rz' position='{}'/><initial link='ball' linear='0 0.1 0'/>", turn), 1e-3);
  for (int i = 0; i < 10; ++i) {
    run_until(tree, 0.05 * (i + 1));
    run_until(loop, 0.05 * (i + 1));
    // Tolerance: Newton's tolerance in each step, amplified by hits.
    EXPECT_LE((tree.link_pose(1).position - loop.link_pose(1).position).norm(), 1e-9) << i;
  }
  EXPECT_GT(tree.energies().dissipated, 0) << "nothing was hit";
}

// ---------------------------------------------------------------- the joint without play is its limit

/// Angle at t = 1.3 s of a pendulum that starts at 0.5 rad from rest. At the start it is pressed into the bearing as
/// without play.
double swung_angle(double play) {
  const double mass = 1, inertia = 0.02, arm = 0.5, k = 1e7, start = 0.5;
  const double whole = inertia + mass * arm * arm, rate = -mass * kG * arm * std::sin(start) / whole;
  const Vector3 force = mass * (arm * rate * Vector3(std::cos(start), 0, std::sin(start)) + Vector3(0, 0, kG));
  const Vector3 pin = -force.normalized() * (play + force.norm() / k);
  Simulation simulation =
      simulation_of(body("rod", mass, {inertia, inertia, 1e-3}, {0, 0, -arm}) +
                        joint("pin", "spherical", "world", "rod",
                              fmt::format("<clearance radius='{}' stiffness='{}' restitution='1'/>", play, k)),
                    fmt::format("<initial joint='pin/x' position='{:.17g}'/><initial joint='pin/z' position='{:.17g}'/>"
                                "<initial joint='pin/ry' position='{:.17g}'/>",
                                pin.x(), pin.z(), -start),
                    2e-4);
  run_until(simulation, 1.3);
  const Quaternion turn = simulation.link_pose(1).orientation;
  return -2 * std::atan2(turn.y(), turn.w());
}

// Angles by scipy; the first one is without play. The error is of first order in the play.
TEST(Clearance, TendsToTheJointWithoutPlay) {
  const double without = 0.3388706415, with[] = {0.3319654137, 0.3354236673, 0.3371476672};
  double last = 0;
  const double plays[] = {4e-3, 2e-3, 1e-3};
  for (int i = 0; i < 3; ++i) {
    const double angle = swung_angle(plays[i]), error = std::abs(angle - without);
    EXPECT_NEAR(angle, with[i], 1e-5);
    if (i > 0) {
      EXPECT_NEAR(last / error, 2, 0.05);
    }
    last = error;
  }
}

// ---------------------------------------------------------------- slider-cranks

/// The mechanism of Flores and Ambrosio, Computers & Structures 82 (2004) 1359: crank at 5000 rpm, 0.5 mm of play
/// between rod and slider, restitution 0.9. A linear stiffness replaces Hertz' law.
Simulation loose_slider_crank(double step) {
  const double speed = 5000 * 2 * std::acos(-1.0) / 60;
  return simulation_of(
      body("crank", 0.3, Vector3::Constant(1e-4), {0.025, 0, 0}) +
          joint("crank", "continuous", "world", "crank", "<axis xyz='0 0 1'/>") +
          body("rod", 0.21, Vector3::Constant(2.5e-4), {0.06, 0, 0}) +
          joint("rod", "continuous", "crank", "rod", "<origin xyz='0.05 0 0'/><axis xyz='0 0 1'/>") +
          body("slider", 0.14, Vector3::Constant(1e-4)) +
          joint("slider", "prismatic", "world", "slider",
                "<axis xyz='1 0 0'/><limit lower='-1' upper='1' effort='0' velocity='0'/>") +
          joint("pin", "continuous", "rod", "slider",
                "<origin xyz='0.12 0 0'/><axis xyz='0 0 1'/><clearance radius='0.5e-3' stiffness='1.5e8' "
                "restitution='0.9' length='0.02'/>",
                "loop_joint"),
      fmt::format("<motion joint='crank' position='5000*2*_pi/60*t'/><initial joint='rod' "
                  "velocity='{:.17g}'/><initial joint='slider' position='0.17'/>",
                  -speed * (1 + 0.05 / 0.12)),
      step, {0, 0, 0});
}

// Angle of the rod and position of the slider by scipy, over the first quarter of a turn with eight hits. A step is
// 0.03 rad of the contact's oscillation, so that speeds after a hit have relative errors of 1e-5 (docs/notes/contact.md
// 7), here 4e-4 rad/s.
TEST(Clearance, SliderCrankMovesAsItsDifferentialEquation) {
  const double expected[][3] = {{0.5e-3, -0.1062508351, 0.1677049211}, {1e-3, -0.211691088, 0.1609249288},
                                {1.5e-3, -0.2945662858, 0.1501454016}, {2e-3, -0.3654820032, 0.1373741086},
                                {2.5e-3, -0.4146597474, 0.1231341345}, {3e-3, -0.4289271376, 0.108902203}};
  Simulation simulation = loose_slider_crank(5e-7);
  const double begin = energy_account(simulation);
  for (const auto& [time, rod, slider] : expected) {
    run_until(simulation, time);
    const Quaternion turn = simulation.link_pose(2).orientation;
    EXPECT_NEAR(2 * std::atan2(turn.z(), turn.w()), rod, 1e-5) << time;
    EXPECT_NEAR(simulation.link_pose(3).position.x(), slider, 1e-6) << time;
  }
  EXPECT_NEAR(energy_account(simulation), begin, 1e-8 * begin);
}

// A block with 1 mm of play in its guide: Flores, Leine and Glocker, Multibody System Dynamics 23 (2010) 165, without
// friction. Angles and rates of the crank are those of Siconos (siconos-tutorials, SliderCrankD1MinusLinearOSI.ref:
// rigid, steps of 1e-5 s), first after the block has come to rest on one wall, then on the other wall. flexarm reaches
// them within two of these steps.
TEST(Clearance, BlockInItsGuideMovesAsPublished) {
  Simulation simulation =
      simulation_of(body("crank", 0.038, Vector3::Constant(7.4e-5), {0.0765, 0, 0}) +
                        joint("crank", "continuous", "world", "crank", "<axis xyz='0 0 1'/>") +
                        body("rod", 0.038, Vector3::Constant(5.9e-4), {0.153, 0, 0}) +
                        joint("rod", "continuous", "crank", "rod", "<origin xyz='0.153 0 0'/><axis xyz='0 0 1'/>") +
                        body("slider", 0.076, Vector3::Constant(2.7e-6)) +
                        joint("wrist", "continuous", "rod", "slider", "<origin xyz='0.306 0 0'/><axis xyz='0 0 1'/>") +
                        joint("guide", "prismatic", "world", "slider",
                              "<axis xyz='1 0 0'/>" + kLimit +
                                  "<clearance radius='1e-3' length='0.1' width='0.05' restitution='0.4' "
                                  "contact_time='1e-4'/>",
                              "loop_joint"),
                    "<initial joint='crank' velocity='150'/><initial joint='rod' velocity='-225'/>"
                    "<initial joint='wrist' velocity='75'/>",
                    1e-5, {0, -kG, 0});
  const double published[][3] = {{0.013, 1.145631, 64.894783}, {0.0302, 2.578025, 129.847146}};
  for (const auto& [time, angle, rate] : published) {
    run_until(simulation, time);
    const Quaternion turn = simulation.link_pose(1).orientation;
    EXPECT_NEAR(2 * std::atan2(turn.z(), turn.w()), angle, 2e-5 * rate) << time;
    EXPECT_NEAR(simulation.velocity(0), rate, 2e-3 * rate) << time;
  }
}

// ---------------------------------------------------------------- friction

// A disc spins in its bearing. It climbs to the angle of friction, and its spin is braked by the moment m g r
// sin(angle).
TEST(Clearance, JournalSlowsDownByItsFriction) {
  const double mass = 2, inertia = 0.004, journal = 0.02, friction = 0.3, climbed = std::atan(friction);
  const double offset = 1e-3 + mass * kG * std::cos(climbed) / 2e6;
  Simulation simulation = simulation_of(
      body("disc", mass, {0.002, inertia, 0.002}) +
          joint("bearing", "continuous", "world", "disc",
                kAcross + fmt::format("<clearance radius='1e-3' journal='{}' length='0.1' stiffness='1e6' "
                                      "restitution='0.1' friction='{}'/>",
                                      journal, friction)),
      fmt::format("<initial link='disc' angular='0 40 0' linear='0 0 0'/><initial joint='bearing/x' "
                  "position='{:.17g}'/><initial joint='bearing/z' position='{:.17g}'/>",
                  offset * std::sin(climbed), -offset * std::cos(climbed)),
      5e-4);
  const double start = energy_account(simulation);
  const auto spin = [&] { return simulation.angular_momentum().y(); };
  run_until(simulation, 0.4);
  const double begin = spin();
  run_until(simulation, 0.6);
  const Vector3 place = simulation.link_pose(1).position;
  EXPECT_NEAR((spin() - begin) / 0.2, -mass * kG * journal * std::sin(climbed), 2e-3 * mass * kG * journal);
  EXPECT_NEAR(std::abs(std::atan2(place.x(), -place.z())), climbed, 5e-3);
  EXPECT_NEAR(energy_account(simulation), start, 1e-9 * start);
}

// ---------------------------------------------------------------- refused scenes

TEST(Clearance, ImpossibleOnesAreRefused) {
  const std::string play = "<clearance radius='1e-3'/>", weight = body("weight", 1, {0.01, 0.01, 0.01});
  const auto refused = [](const std::string& parts, const std::string& starts) {
    return refusal<ModelError>([&] { simulation_of(parts, starts, 1e-3); });
  };
  EXPECT_EQ(
      refused(weight + joint("pin", "spherical", "world", "weight", play), "<initial joint='pin/x' position='3e-3'/>"),
      "test.urdf:1: <clearance> of joint 'pin': penetrates by 0.002 m at the start; expected at most its play, "
      "0.001 m");
  EXPECT_EQ(refused(weight + joint("pin", "spherical", "world", "weight") + body("other", 1, {0.01, 0.01, 0.01}) +
                        joint("weld", "fixed", "weight", "other") +
                        joint("ball", "spherical", "weight", "other", play, "loop_joint"),
                    ""),
            "test.urdf:1: <clearance> of joint 'ball': both links belong to the same rigid body");
}

}  // namespace
}  // namespace flexarm::test::touching
