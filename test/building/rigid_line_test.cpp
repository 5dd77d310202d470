// Tests beams without elements: rigid bodies with the mass of the beam, with everything attached to it.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "building/expect_model_error.h"
#include "flexarm/scene/point_spring.h"
#include "math/so3.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using scene::SensorKind;

/// Round-off of sums of a few hundred terms.
constexpr double kRoundOff = 1e-13;

scene::DirectSection plain() {
  return {2e5, 1e5, 1e5, 60, 80, 90, 0.7, 3e-3, 1e-3, 2e-3};
}

scene::CentrelinePiece arc(const Vector3& to, const Vector3& center, double twist = 0) {
  scene::CentrelinePiece piece;
  piece.kind = scene::CentrelinePiece::Kind::Arc;
  piece.to = to;
  piece.center = center;
  piece.twist = twist;
  return piece;
}

scene::MatrixSection off_centre() {
  const Vector3 center(0, 0.03, -0.02);
  const double mass = 1.3;
  scene::MatrixSection section{Matrix6::Identity() * 1e4, Matrix6::Zero()};
  section.inertia.topLeftCorner<3, 3>() = mass * Matrix3::Identity();
  section.inertia.topRightCorner<3, 3>() = -mass * so3::hat(center);
  section.inertia.bottomLeftCorner<3, 3>() = mass * so3::hat(center);
  const Matrix3 about_center = Vector3(5e-3, 2e-3, 3e-3).asDiagonal();
  section.inertia.bottomRightCorner<3, 3>() = about_center - mass * so3::hat(center) * so3::hat(center);
  return section;
}

struct Line {
  std::string name;
  std::function<void(scene::BeamDescription&)> shape;
};
std::ostream& operator<<(std::ostream& out, const Line& line) {
  return out << line.name;
}

std::vector<Line> lines() {
  const auto bend = [](scene::BeamDescription& beam) {
    beam.centreline.push_back(arc({1.1, 0.5, 0.1}, {0.6, 0.5, 0.1}, 0.7));
    beam.centreline.front().to = Vector3(0.6, 0, 0.1);
  };
  return {{"straight", [](scene::BeamDescription&) {}},
          {"kinked",
           [](scene::BeamDescription& beam) {
             beam.centreline.push_back({scene::CentrelinePiece::Kind::Line, {1, 0.8, -0.3}, {}, 0.4, {}});
           }},
          {"arc", bend},
          {"stations",
           [bend](scene::BeamDescription& beam) {
             bend(beam);
             scene::DirectSection thin = plain();
             thin.mass = 0.2;
             thin.j1 = 4e-4;
             beam.section = scene::SectionStations{{0.1, 1.0}, {plain(), thin}};
           }},
          {"off_centre",
           [bend](scene::BeamDescription& beam) {
             bend(beam);
             beam.section = off_centre();
           }},
          {"hubs", [bend](scene::BeamDescription& beam) {
             bend(beam);
             beam.section = off_centre();
             beam.hubs = {{scene::HubDescription::End::Start, 0.4, {0.01, 0.02, 0.03}, {}},
                          {scene::HubDescription::End::End, 0.9, {0.03, 0.01, 0.02}, {}}};
           }}};
}

/// The line in free flight and rotation, with this number of elements; none: elements="auto".
SceneBuilder flying(const Line& line, int order, std::optional<int> elements) {
  SceneBuilder b;
  b.scene.gravity = {0.5, -2, -9.81};
  scene::BeamDescription& beam = b.beam("line", {{0.8, 0.3, 0.1}}, plain(), 1, order);
  line.shape(beam);
  beam.elements = elements;
  b.joint("free", JointKind::Floating, "world", "line", {0.1, -0.2, 0.3});
  const char* names[] = {"free/x", "free/y", "free/z", "free/rx", "free/ry", "free/rz"};
  const double positions[] = {0.3, -0.1, 0.2, 0.5, -0.8, 0.3}, velocities[] = {1, -2, 0.7, 3, 2, -4};
  for (int i = 0; i < 6; ++i) b.scene.initial_joints.push_back({names[i], positions[i], velocities[i], {}, true});
  return b;
}

class RigidLine : public ::testing::TestWithParam<std::tuple<Line, int>> {};

TEST_P(RigidLine, HasTheMassOfTheFlexibleOne) {
  const auto& [line, order] = GetParam();
  for (const char* scheme : {"em", "m1", "newmark"}) {
    SceneBuilder flexible_scene = flying(line, order, std::nullopt), rigid_scene = flying(line, order, 0);
    flexible_scene.scene.integrator.scheme = rigid_scene.scene.integrator.scheme = scheme;
    const Simulation flexible(flexible_scene.scene), rigid(rigid_scene.scene);
    EXPECT_TRUE(flexible.is_flexible(1));
    EXPECT_FALSE(rigid.is_flexible(1));
    EXPECT_EQ(rigid.degrees_of_freedom(), 6u);
    EXPECT_NEAR(rigid.mass(), flexible.mass(), kRoundOff * flexible.mass());
    const Vector3 momentum = flexible.momentum(), spin = flexible.angular_momentum();
    EXPECT_LT((rigid.momentum() - momentum).norm(), kRoundOff * momentum.norm());
    const Energies a = flexible.energies(), b = rigid.energies();
    EXPECT_NEAR(b.potential, a.potential, kRoundOff * std::abs(a.potential));
    EXPECT_EQ(b.strain, 0);
    // If sections are not parallel, the rotary inertia that a scheme lumps at nodes is an approximation.
    if (make_scheme(flexible_scene.scene.integrator).nodal_rotary_inertia && line.name != "straight") continue;
    EXPECT_LT((rigid.angular_momentum() - spin).norm(), kRoundOff * spin.norm());
    EXPECT_NEAR(b.kinetic, a.kinetic, kRoundOff * a.kinetic);
  }
}

// Its end and its line have the positions of the flexible line.
TEST_P(RigidLine, HasTheShapeOfTheFlexibleOne) {
  const auto& [line, order] = GetParam();
  const Simulation flexible(flying(line, order, std::nullopt).scene), rigid(flying(line, order, 0).scene);
  const Pose a = flexible.tip_pose(1), b = rigid.tip_pose(1);
  EXPECT_LT((a.position - b.position).norm(), kRoundOff);
  EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-7);  // angle near 0, computed from its cosine
  EXPECT_EQ(flexible.beam_radius(1), rigid.beam_radius(1));
  std::vector<BeamPoint> bent, stiff;
  flexible.beam_points(1, 0, bent);
  rigid.beam_points(1, 0, stiff);
  ASSERT_EQ(bent.size(), stiff.size());
  ASSERT_EQ(rigid.undeformed_sections(1, 3).size(), stiff.size());
  for (std::size_t i = 0; i < bent.size(); ++i) {
    EXPECT_NEAR(bent[i].arc_length, stiff[i].arc_length, kRoundOff);
    EXPECT_LT((bent[i].pose.position - stiff[i].pose.position).norm(), kRoundOff);
    EXPECT_LT(bent[i].pose.orientation.angularDistance(stiff[i].pose.orientation), 1e-7);
    EXPECT_TRUE(stiff[i].strain.isZero(0));
    EXPECT_TRUE(stiff[i].resultant.array().isNaN().all()) << "nothing is known of it";
  }
}

INSTANTIATE_TEST_SUITE_P(Lines, RigidLine, ::testing::Combine(::testing::ValuesIn(lines()), ::testing::Range(1, 5)),
                         [](const auto& info) {
                           return std::get<0>(info.param).name + "_" + std::to_string(std::get<1>(info.param));
                         });

/// Sum of all outside loads, about the world's origin.
Wrench sum_of_loads(const Simulation& simulation) {
  std::vector<ActingWrench> wrenches;
  simulation.outside_wrenches(wrenches);
  Wrench sum;
  for (const ActingWrench& each : wrenches) {
    sum.force += each.wrench.force;
    sum.moment += each.wrench.moment + each.position.cross(each.wrench.force);
  }
  return sum;
}

TEST(RigidLine, TakesTheResultantsOfWhatIsDistributed) {
  for (const Line& line : lines())
    for (const auto frame : {scene::LoadFrame::World, scene::LoadFrame::Follower})
      for (const auto& [from, to] :
           {std::pair<std::optional<double>, std::optional<double>>({}, {}), {0.2, {}}, {0.3, 0.7}}) {
        SCOPED_TRACE(line.name);
        // In both scenes, the ends of loads are borders of elements.
        SceneBuilder bent = flying(line, 2, std::nullopt), stiff = flying(line, 2, 0);
        for (SceneBuilder* b : {&bent, &stiff})
          b->scene.distributed_loads.push_back({"line", {3, -2, 1}, frame, TimeFunction(0.7), {}, from, to});
        const Wrench a = sum_of_loads(Simulation(bent.scene)), b = sum_of_loads(Simulation(stiff.scene));
        EXPECT_LT((a.force - b.force).norm(), kRoundOff * a.force.norm());
        EXPECT_LT((a.moment - b.moment).norm(), kRoundOff * a.moment.norm());
      }
}

/// A double pendulum whose first link is a straight uniform line, with everything that may be attached to it.
SceneBuilder pendulum(bool as_body) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  const double length = 0.9;
  if (as_body) {
    const double mass = 0.7 * length, across = mass * length * length / 12;
    b.body("upper", mass, {0, 0, -0.5 * length},
           // The section's y is the link's y; its 1 is along -z, its 3 along x.
           Vector3(across + 2e-3 * length, across + 1e-3 * length, 3e-3 * length).asDiagonal());
  } else {
    b.beam("upper", {{0, 0, -length}}, plain(), 0, 2).section_y = Vector3(0, 1, 0);
  }
  b.joint("hinge", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.body("lower", 0.5, {0.1, 0.05, -0.3}, Vector3(0.02, 0.03, 0.015).asDiagonal());
  b.joint("knee", JointKind::Spherical, "upper", "lower", {0, 0, -length});
  b.scene.initial_joints.push_back({"hinge", 0.8, 0.5, {}, true});
  b.load("upper", {0, 0.02, -0.4}, {0.3, 0.2, 0.1}, {0.01, 0, 0.02}, "t", scene::LoadFrame::Follower);
  auto spring = std::make_shared<scene::PointSpring>();
  spring->from = "world", spring->from_at = {0.3, 0, 0};
  spring->to = "upper", spring->to_at = {0, 0, -0.5};
  spring->stiffness = 40, spring->damping = 0.3;
  b.scene.force_elements.push_back(spring);
  b.probe("middle", "upper", {0.01, 0, -0.45});
  b.sensor("reaction", SensorKind::Reaction, "upper");
  b.sensor("wrench", SensorKind::Wrench, "lower");
  b.sensor("imu", SensorKind::Imu, "upper", {0, 0, -0.6});
  b.sensor("pose", SensorKind::Pose, "upper", {0, 0, -0.6});
  return b;
}

// Motion and measurements are those of a body with the same inertia.
TEST(RigidLine, CarriesWhatABodyDoes) {
  for (const char* scheme : {"em", "em4", "m1", "newmark"}) {
    SceneBuilder line_scene = pendulum(false), body_scene = pendulum(true);
    line_scene.scene.integrator.scheme = body_scene.scene.integrator.scheme = scheme;
    Simulation line(line_scene.scene), body(body_scene.scene);
    line.apply_wrenches({{1, {0, 0, -0.7}, {{0, 0.4, 0}, {0, 0, 0}}, true, {}}});
    body.apply_wrenches({{1, {0, 0, -0.7}, {{0, 0.4, 0}, {0, 0, 0}}, true, {}}});
    for (int n = 0; n < 100; ++n) {
      ASSERT_TRUE(line.step().converged);
      ASSERT_TRUE(body.step().converged);
    }
    // Tolerance: round-off of the inertias, in a motion over a tenth of a second.
    EXPECT_LT((line.probe(0).pose.position - body.probe(0).pose.position).norm(), 1e-11) << scheme;
    EXPECT_LT((line.probe(0).velocity - body.probe(0).velocity).norm(), 1e-9) << scheme;
    for (std::size_t sensor = 0; sensor < 4; ++sensor)
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(line.sample(sensor).values[k], body.sample(sensor).values[k], 1e-6) << scheme << sensor;
  }
}

// Six joints give six unknowns, and no beam is left for a step to evaluate.
TEST(RigidLine, LeavesNothingOfBeamsToAStep) {
  SceneBuilder b;
  std::string parent = "world";
  for (int i = 0; i < 6; ++i) {
    const std::string name = "link" + std::to_string(i);
    b.beam(name, {{0.3, 0.05 * i, 0}}, plain(), 0, 2);
    b.joint("joint" + std::to_string(i), JointKind::Revolute, parent, name,
            i == 0 ? Vector3(0, 0, 0) : Vector3(0.3, 0.05 * (i - 1), 0), i % 2 ? Vector3(0, 1, 0) : Vector3(0, 0, 1));
    parent = name;
  }
  Simulation simulation(b.scene);
  EXPECT_EQ(simulation.degrees_of_freedom(), 6u);
  EXPECT_EQ(simulation.node_count(), 6u) << "one for each link";
  ASSERT_TRUE(simulation.step().converged);
  const Model& model = model_of(simulation);
  int elements = 0;
  for_each_element(model.beams, [&](const auto&) { ++elements; });
  EXPECT_EQ(elements, 0);
  EXPECT_EQ(model.stiffness_point_count, 0);
  EXPECT_EQ(model.mass_point_count, 0);
  const State& state = state_of(simulation);
  EXPECT_TRUE(state.study.mass_points.empty() && state.study.strain_rates.empty() && state.strain_memory.empty());
  EXPECT_EQ(simulation.energies().strain, 0);
}

scene::SceneDescription arm_with(const std::function<void(SceneBuilder&, scene::BeamDescription&)>& change) {
  SceneBuilder b;
  scene::BeamDescription& beam = b.beam("arm", {{1, 0, 0}}, plain(), 0, 2);
  beam.location = {"s.urdf", 7};
  b.joint("hinge", JointKind::Revolute, "world", "arm");
  change(b, beam);
  return b.scene;
}

TEST(RigidLine, IsRefusedWhereItWouldHaveToBend) {
  expect_error(arm_with([](auto&, auto& beam) { beam.prestrain[4] = TimeFunction(0.1); }),
               "s.urdf:7: <beam> of link 'arm': with elements=\"0\" it is rigid, and <prestrain> would bend it");
  expect_error(arm_with([](auto&, auto& beam) { beam.mass_proportional_damping = 0.1; }),
               "s.urdf:7: <beam> of link 'arm': with elements=\"0\" it is rigid, and mass-proportional <damping>");
  for (const SensorKind kind : {SensorKind::Strain, SensorKind::SectionForce})
    expect_error(arm_with([&](SceneBuilder& b, auto&) {
                   b.sensor("gauge", kind, "arm");
                   b.scene.sensors.back().location = {"s.urdf", 21};
                 }),
                 "s.urdf:21: <sensor> 'gauge': the <beam> of link 'arm' is rigid: it has elements=\"0\"");
  expect_error(arm_with([&](SceneBuilder& b, auto&) {
                 b.body("cart", 1, {0, 0, 0}, Matrix3::Identity());
                 scene::JointDescription& joint = b.joint("rail", JointKind::Slide, "arm", "cart");
                 joint.slide.emplace().location = {"s.urdf", 33};
               }),
               "s.urdf:33: <slide> of joint 'rail': the <beam> of link 'arm' is rigid: it has elements=\"0\"");
  expect_error(arm_with([&](SceneBuilder& b, auto&) {
                 b.scene.distributed_loads.push_back(
                     {"arm", {0, 1, 0}, scene::LoadFrame::World, TimeFunction(1), {"s.urdf", 40}, {}, 1.5});
               }),
               "s.urdf:40: <distributed_load>: the line of link 'arm' is 1.000000 m long, got 1.5");
  expect_error(arm_with([](auto&, auto& beam) { beam.centreline.front().to.setZero(); }),
               "s.urdf:7: <centerline> of link 'arm'");
}

// Without a joint that moves it, it is fixed in the world.
TEST(RigidLine, MayBeClamped) {
  SceneBuilder b;
  b.beam("post", {{0, 0, 1}}, plain(), 0, 2);
  b.joint("clamp", JointKind::Fixed, "world", "post", {1, 0, 0});
  b.body("arm", 1, {0.5, 0, 0}, Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "post", "arm", {0, 0, 1});
  Simulation simulation(b.scene);
  EXPECT_EQ(simulation.degrees_of_freedom(), 1u);
  EXPECT_TRUE(simulation.tip_pose(1).position.isApprox(Vector3(1, 0, 1)));
  ASSERT_TRUE(simulation.step().converged);
}

}  // namespace
}  // namespace flexarm::test
