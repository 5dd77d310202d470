// Tests what a <cylinder> is for users: names, columns, errors, flexible ends, conservation.
#include <cmath>

#include "flexarm/simulation/payloads.h"
#include "support/boom.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

using NameList = std::vector<std::string>;

/// A hull and a boom on a ball joint, with a cylinder between them. `root`: type of the joint that carries the hull.
std::string ball_and_strut(const std::string& root, const std::string& parts, const std::string& simulation) {
  const std::string body =
      "<inertial><origin xyz='0.2 0.05 0.1'/><mass value='4'/>"
      "<inertia ixx='0.2' iyy='0.3' izz='0.25' ixy='0.01' ixz='0.02' iyz='0'/></inertial>";
  return "<robot name='strutted'><link name='world'/><link name='hull'>" + body + "</link><link name='boom'>" + body +
         "</link><joint name='root' type='" + root +
         "'><parent link='world'/><child link='hull'/></joint>"
         "<joint name='ball' type='floating'><parent link='hull'/><child link='boom'/><origin xyz='0.1 0 0.2'/>"
         "<release kind='spherical'/></joint>"
         "<cylinder name='strut' from='hull' from_at='0.4 0.1 0' to='boom' to_at='0.4 0 0.2'>" +
         parts + "</cylinder><simulation><integrator step='0.01' tolerance='1e-12'/>" + simulation +
         "<initial joint='ball/ry' velocity='0.4'/><initial joint='ball/rz' velocity='0.3'/></simulation></robot>";
}

/// Runs 10,000 steps. The points must stay on the cylinder's line, and the length must change.
void run_long(Simulation& simulation) {
  const auto pose = [&](const char* link) { return simulation.link_pose(link_of(simulation, link)); };
  double shortest = 1e9, longest = 0;
  run(simulation, 10000, [&] {
    shortest = std::min(shortest, position_of(simulation, "strut"));
    longest = std::max(longest, position_of(simulation, "strut"));
  });
  EXPECT_GT(longest, shortest + 0.05);
  EXPECT_LT((pose("strut_rod").position - pose("boom") * Vector3(0.4, 0, 0.2)).norm(), 1e-9);
}

const char* const kWithoutMass = "";
const char* const kWithMass =
    "<barrel mass='0.5' length='0.2' radius='0.02'/><rod mass='0.3' length='0.2'/><spring stiffness='40'/>";

}  // namespace

TEST(CylinderScene, ShowsItsLengthAndHidesItsHinges) {
  const Simulation simulation(boom_scene(0.2, "", ""));
  EXPECT_EQ(simulation.coordinate_names(), (NameList{"hinge", "lift"}));
  EXPECT_EQ(simulation.link_names(), (NameList{"world", "boom", "lift_barrel", "lift_rod"}));
  EXPECT_FALSE(simulation.find_coordinate("lift_hinge/1"));
  EXPECT_TRUE(simulation.start_warnings().empty());
  NameList joints;
  const ResultColumns columns(simulation, ResultColumns::Solver::Without);
  for (const ResultColumn& column : columns.columns())
    if (column.name.find("joint/") == 0) joints.push_back(column.name);
  EXPECT_EQ(joints, (NameList{"joint/hinge/position", "joint/hinge/velocity", "joint/hinge/effort",
                              "joint/lift/position", "joint/lift/velocity", "joint/lift/effort"}));
  const Pose barrel = simulation.link_pose(2), rod = simulation.link_pose(3);
  EXPECT_LT((barrel.position - Vector3(0.3, 0, -0.3)).norm(), 1e-12);
  EXPECT_LT((rod.position - simulation.link_pose(1) * Vector3(0.3, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR((rod.position - barrel.position).norm(), simulation.position(1), 1e-12);
  EXPECT_LT((barrel * Vector3(simulation.position(1), 0, 0) - rod.position).norm(), 1e-12);
  for (const std::size_t part : {2, 3}) ASSERT_EQ(simulation.scene().links[part].visuals.size(), 1u);
}

TEST(CylinderScene, TellsWhatIsWrongAtTheStart) {
  EXPECT_EQ(refusal_of(boom_scene(0, "", "<motion joint='lift' position='0.3+0.1*t'/>")), "");
  EXPECT_EQ(refusal_of(boom_scene(0.2, "", "<motion joint='lift' position='0.3+0.1*t'/>")),
            "test.urdf:5: <cylinder> 'lift': its length at the start is 0.3596505186 m, but its motion begins at 0.3");
  scene::SceneDescription closed = boom_scene(0, "", "");
  closed.cylinders[0].to_at = closed.cylinders[0].from_at;
  for (scene::JointDescription& loop : closed.loop_joints) loop.child_origin.position = closed.cylinders[0].to_at;
  EXPECT_NE(refusal_of(closed).find("its points coincide at the start"), std::string::npos);
  const Simulation outside(boom_scene(0, "<limit lower='0.4' upper='0.6'/>", ""));
  ASSERT_EQ(outside.start_warnings().size(), 1u);
  EXPECT_EQ(outside.start_warnings()[0].text(),
            "test.urdf:5: warning: <cylinder> 'lift': starts outside its limits, 0.4 to 0.6, and its stop will push it "
            "back, got '0.3' m");
}

TEST(CylinderScene, ConservesEnergyInSpace) {
  for (const char* parts : {kWithoutMass, kWithMass}) {
    Simulation simulation(scene_of(ball_and_strut("fixed", parts, "")));
    const double energy = simulation.energies().total();
    run_long(simulation);
    EXPECT_NEAR(simulation.energies().total(), energy, 1e-11 * std::abs(energy)) << parts;
  }
}

// The tolerances are three times what the same two bodies on their ball joint alone need, without a cylinder.
TEST(CylinderScene, ConservesMomentaInFlight) {
  for (const char* parts : {kWithoutMass, kWithMass}) {
    Simulation simulation(scene_of(ball_and_strut(
        "floating", parts, "<gravity xyz='0 0 0'/><initial link='hull' linear='0.03 0.01 0' angular='0.5 -1 0.7'/>")));
    const double energy = simulation.energies().total();
    const Vector3 momentum = simulation.momentum(), angular = simulation.angular_momentum();
    run_long(simulation);
    EXPECT_NEAR(simulation.energies().total(), energy, 3e-10 * energy) << parts;
    EXPECT_LT((simulation.momentum() - momentum).norm(), 3e-10 * momentum.norm()) << parts;
    EXPECT_LT((simulation.angular_momentum() - angular).norm(), 1e-8 * angular.norm()) << parts;
  }
}

// On flexible links the section at the point carries the cylinder.
TEST(CylinderScene, HoldsFlexibleLinks) {
  for (const char* at : {"0.6 0 0", "1 0 0"}) {
    const double arm = std::stod(at);
    Simulation simulation(scene_of(fmt::format(R"(<robot name='crane'><link name='world'/>
      <joint name='hinge' type='continuous'><parent link='world'/><child link='jib'/><axis xyz='0 -1 0'/></joint>
      <link name='jib'><beam elements='4'><centerline><line to='1 0 0'/></centerline><circle radius='0.01'/>
        <material young='70e9' poisson='0.33' density='2700'/></beam></link>
      <cylinder name='lift' from='world' from_at='0 0 -1' to='jib' to_at='{}'/>
      <simulation><motion joint='lift' position='{:.17g}'/><probe name='eye' link='jib' at='{}'/></simulation></robot>)",
                                               at, std::hypot(arm, 1.0), at)));
    EXPECT_EQ(simulation.coordinate_names(), (NameList{"hinge", "lift"}));
    ASSERT_TRUE(simulation.solve_static(1).converged);
    const double start = energy_account(simulation);
    run(simulation, 200);
    const Vector3 eye = simulation.probe_pose(0).position;
    EXPECT_NEAR((eye - Vector3(0, 0, -1)).norm(), simulation.position(1), 1e-9);
    EXPECT_NEAR(energy_account(simulation), start, 1e-9);
    // Moments about the hinge. The jib bends by a millimetre, which changes them by its square.
    const double weight = 9.81 * simulation.mass(), lever = arm * 1 / std::hypot(arm, 1.0);
    EXPECT_NEAR(simulation.effort(1), weight * 0.5 / lever, 2e-3 * weight);
  }
}

TEST(CylinderScene, HasSensorsAtItsEnds) {
  scene::SceneDescription scene =
      boom_scene(0.3, "", fmt::format("<motion joint='lift' position='{:.17g}'/>", BoomOnParts::length(0.3)));
  for (const auto& [name, link, joint] :
       {std::tuple("foot", "lift_barrel", ""), std::tuple("eye", "boom", "lift_pin")}) {
    scene::Sensor sensor;
    sensor.name = name;
    sensor.kind = scene::SensorKind::Reaction;
    sensor.link = link;
    sensor.joint = joint;
    scene.sensors.push_back(sensor);
  }
  Simulation simulation(scene);
  run(simulation, 3);
  const double slope = BoomOnParts::slope(0.3);
  const Vector3 force = simulation.effort(1) * Vector3(std::cos(slope), 0, std::sin(slope));
  for (const std::size_t sensor : {0, 1}) {
    const auto& values = simulation.sample(sensor).values;
    EXPECT_LT((Vector3(values[0], values[1], values[2]) - force).norm(), 1e-7 * force.norm()) << sensor;
  }
}

TEST(CylinderScene, IsMimicked) {
  scene::SceneDescription scene = boom_scene(0.3, "", "");
  scene::JointDescription pointer;
  pointer.name = "pointer";
  pointer.kind = scene::JointKind::Continuous;
  pointer.parent = "world";
  pointer.child = "needle";
  pointer.mimic = scene::Mimic{"lift", 10, -3};
  scene.joints.push_back(pointer);
  scene.links.push_back({"needle", scene::RigidInertia{1e-3, {0.1, 0, 0}, 1e-5 * Matrix3::Identity()}, {}});
  Simulation simulation(scene);
  const std::size_t needle = simulation.find_coordinate("pointer").value(),
                    lift = simulation.find_coordinate("lift").value();
  EXPECT_NEAR(simulation.position(needle), 10 * BoomOnParts::length(0.3) - 3, 1e-12);
  run(simulation, 100);
  EXPECT_NEAR(simulation.position(needle), 10 * simulation.position(lift) - 3, 1e-12);
  EXPECT_GT(std::abs(simulation.position(lift) - BoomOnParts::length(0.3)), 1e-3);
}

TEST(CylinderScene, ComesAndGoesWithModels) {
  Simulation simulation(boom_scene(0.2, "", ""));
  run(simulation, 20);
  const double length = simulation.position(1);
  Spawn where;
  where.prefix = "b_";
  where.pose.position = {0, 2, 1};
  spawn(simulation, boom_scene(0.1, "<dynamics damping='10'/>", ""), where);
  EXPECT_EQ(simulation.coordinate_names(), (NameList{"hinge", "lift", "b_hinge", "b_lift"}));
  EXPECT_NEAR(simulation.position(1), length, 1e-12);
  EXPECT_NEAR(simulation.position(3), BoomOnParts::length(0.1), 1e-12);
  run(simulation, 20);
  remove(simulation, "lift_barrel");  // the cylinder alone
  EXPECT_EQ(simulation.coordinate_names(), (NameList{"hinge", "b_hinge", "b_lift"}));
  run(simulation, 20);
  remove(simulation, "b_boom");  // and the cylinder on it
  EXPECT_EQ(simulation.coordinate_names(), (NameList{"hinge"}));
  EXPECT_EQ(simulation.link_names(), (NameList{"world", "boom"}));
  ASSERT_TRUE(simulation.step().converged);
}

TEST(CylinderScene, GoesIntoCheckpoints) {
  const scene::SceneDescription scene = boom_scene(0.2, "", "<effort joint='lift' history='100'/>", {1, 1});
  Simulation one(scene), other(scene);
  for (int n = 0; n < 50; ++n) one.step();
  other.restore(one.snapshot());
  for (int n = 0; n < 50; ++n) one.step(), other.step();
  EXPECT_NEAR(one.position(1), other.position(1), 1e-13);
  Simulation copy = one.copy();
  copy.reset();
  EXPECT_NEAR(copy.position(1), BoomOnParts::length(0.2), 1e-15);
}

}  // namespace flexarm::test
