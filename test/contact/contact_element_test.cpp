// Tests contacts of points with shapes over a step: exact work, conservation of momenta, tangents of their forces.
#include "contact/contact_element.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"
#include "support/gripping_law.h"
#include "support/node_poses.h"
#include "support/polytopes.h"

namespace flexarm::test {
namespace {

using Poses = std::vector<NodePose>;

ContactLaw gripping_law(double friction, double restitution) {
  ContactLaw law = test::gripping_law(friction, restitution, 0.6);
  law.spinning = 0.1 * friction;
  law.rolling = 0.04 * friction;
  law.turn_grip = 30;
  return law;
}

struct Scene {
  const char* name;
  ContactStations side;
  ContactSurface surface;
};

/// Scenes of a ball and a corner, a rim, or a rod on node 0, and of an element with nodes 0, 2, 3, against shapes on
/// node 1 or on the world.
std::vector<Scene> scenes() {
  const Pose place{{0.05, -0.02, 0.03}, so3::exp_quaternion(Vector3(0.2, 0.1, -0.3))};
  const std::vector<ContactShape> shapes = {{HalfSpace{}, {place * Vector3(0, 0, 0.3), place.orientation}},
                                            {Ball{0.3}, place},
                                            {Box{{0.4, 0.5, 0.3}}, place},
                                            {Cylinder{0.45, 0.3}, place},
                                            {Ball{0.4}, place, true},
                                            {Cylinder{0.3, std::numeric_limits<double>::infinity()}, place, true},
                                            {Hull{std::make_shared<Polytope>(roof_polytope({0.4, 0.5, 0.2}, 0.1))},
                                             {place.position + Vector3(0.1, 0, 0), place.orientation}}};
  ContactStation ball, corner, tube, rim, rod, leaning;
  ball.arm = {0.1, 0.05, -0.1};
  ball.radius = 0.2;
  corner.arm = {0.05, 0.1, -0.24};
  tube.weights = {0.3, 0.5, 0.2};
  tube.radius = 0.25;
  tube.share = 0.7;
  rim.arm = {0.05, 0.02, -0.05};
  rim.rim = 0.25;
  rim.axis = Vector3(1, 0.3, 0.5).normalized();
  rod.arm = {0.05, 0.02, -0.05};
  rod.radius = 0.15;
  rod.half = 0.6;
  rod.curvature = leaning.curvature = 0.01;
  rod.axis = Vector3(1, 0.5, -0.1).normalized();
  leaning.arm = {0.5, 0, 0.14};
  leaning.radius = 0.3;
  leaning.half = 0.6;
  leaning.axis = Vector3(1, 0.3, -1).normalized();
  std::vector<Scene> out;
  const char* names[] = {"half-space", "ball", "box", "cylinder", "socket", "bearing", "hull"};
  for (std::size_t k = 0; k < shapes.size(); ++k)
    for (const int base : {1, -1}) {
      out.push_back({names[k], {{0}, {ball, corner}}, {base, {shapes[k]}}});
      out.push_back({names[k], {{0, 2, 3}, {tube}}, {base, {shapes[k]}}});
      if (!shapes[k].is_hollow && k > 0) {  // the axis of a rod stays outside
        ContactStation over = k == 1 ? rod : leaning;
        if (k == 6) over.arm += Vector3(0.1, 0, 0.1);
        out.push_back({names[k], {{0}, {over}}, {base, {shapes[k]}}});
      }
      if (is_flat(shapes[k])) out.push_back({names[k], {{0}, {rim}}, {base, {shapes[k]}}});
    }
  return out;
}

class ContactElements : public ::testing::Test {
 protected:
  struct Action {
    Eigen::VectorXd residual;
    Eigen::MatrixXd tangent;
    double dissipated = 0, let_out = 0;
    std::vector<double> memory;
  };

  Action action(const Poses& at_end, const ContactElement& element, const Poses& at_begin, const Vector3& stretched,
                bool at_rest, double duration = 0.05) const {
    ForceStep step{at_begin, at_end, velocities};
    step.duration = at_rest ? 0.0 : duration;
    step.at_end = at_rest;
    std::vector<double> memory(element.memory_size(), 0.0);
    for (std::size_t i = 0; i < memory.size(); i += PointMemory::kSize) {
      memory[i] = 0.3;
      Eigen::Map<Vector3>(memory.data() + i + 1) = stretched;
      memory[i + 6] = inside;
      if (!stretched.isZero(0)) Eigen::Map<Vector3>(memory.data() + i + 7) = turned;
    }
    Action out;
    out.memory.resize(memory.size());
    step.memory = memory.data();
    step.new_memory = out.memory.data();
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(element.reach().size());
    out.residual.resize(size);
    out.tangent.resize(size, size);
    ForceAction action{{out.residual.data(), size}, {out.tangent.data(), size, size}};
    element.evaluate(step, element.reach().data(), action);
    out.dissipated = action.dissipated;
    out.let_out = action.work;
    return out;
  }

  const Vector3 stretch{0.004, -0.003, 0.002};  // of the friction spring at the beginning
  const double inside = 0.003;                  // initial penetration, see let_out()
  const Vector3 turned{0.02, 0.01, -0.03};      // rotation of the springs that resist rotation, at the beginning
  const std::vector<Vector6> velocities = std::vector<Vector6>(4, Vector6::Constant(0.2));
  const Poses begin{turned_node({0.1, 0.05, 0.52}, {-0.1, 0.2, 0.2}), turned_node({0, 0, 0}, {0.2, 0.1, -0.3}),
                    turned_node({0.15, 0.1, 0.5}, {0, 0.1, 0}), turned_node({0.2, 0.3, 0.45}, {0.1, 0.1, 0})};
  const Poses end{turned_node({0.12, 0.07, 0.46}, {-0.15, 0.35, 0.3}),
                  turned_node({0.01, -0.02, 0.03}, {0.3, 0.05, -0.2}),
                  turned_node({0.17, 0.12, 0.45}, {0.05, 0.2, 0.1}), turned_node({0.22, 0.28, 0.42}, {0.2, 0.1, 0.1})};
};

/// Tests for forces at the end of a step and for mean forces.
class OverSteps : public ContactElements, public ::testing::WithParamInterface<bool> {
 protected:
  using ContactElements::action;
  Action action(const Poses& at_end, const ContactElement& element) const {
    return action(at_end, element, begin, stretch, GetParam());
  }
};

// Central differences with the step 1e-6 have truncation errors of 1e-12 times third derivatives, and round-off of
// 1e-16 / 1e-6 times the forces.
TEST_P(OverSteps, HaveTheirTangent) {
  for (const auto& [name, side, surface] : scenes())
    for (const double friction : {0.0, 0.05, 5.0}) {
      const ContactElement element({"", ""}, side, surface, gripping_law(friction, 0.5));
      const Action here = action(end, element);
      EXPECT_GT(here.residual.norm(), 1) << name << " is not touched";
      constexpr double h = 1e-6;
      for (Eigen::Index k = 0; k < here.residual.size(); ++k) {
        const auto residual = [&](double way) {
          Vector6 by = Vector6::Zero();
          by[k % 6] = way;
          Poses at = end;
          NodePose& node = at[element.reach()[static_cast<std::size_t>(k / 6)]];
          node = moved(node, by);
          return action(at, element).residual;
        };
        const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
        EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-6 * here.tangent.norm())
            << name << " " << friction << " " << k << " " << surface.node << " " << side.nodes.size();
      }
    }
}

TEST_P(OverSteps, AddToNoMomentum) {
  for (const auto& [name, side, surface] : scenes()) {
    if (surface.node < 0) continue;
    const ContactElement element({"", ""}, side, surface, gripping_law(0.3, 0.5));
    const Action here = action(end, element);
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
    const double weight = GetParam() ? 1 : 0.5;
    for (std::size_t i = 0; i < element.reach().size(); ++i) {
      const int node = element.reach()[i];
      const Vector3 arm = (1 - weight) * begin[node].position + weight * end[node].position;
      const Vector6 on_node = here.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
      force += on_node.head<3>();
      moment += arm.cross(on_node.head<3>()) + on_node.tail<3>();
    }
    EXPECT_LE(force.norm(), 1e-14 * here.residual.norm()) << name;
    EXPECT_LE(moment.norm(), 1e-13 * here.residual.norm()) << name;
  }
}

// The work of mean forces over the step equals the change of energy plus dissipation, less the work of decaying initial
// penetrations (let_out()), to round-off.
TEST_P(OverSteps, OfMeansDoExactWork) {
  if (GetParam()) return;  // does not hold for forces at the end
  for (const auto& [name, side, surface] : scenes())
    for (const double friction : {0.01, 0.3, 5.0}) {
      const ContactElement element({"", ""}, side, surface, gripping_law(friction, 0.5));
      const Action here = action(end, element);
      double work = 0;
      for (std::size_t i = 0; i < element.reach().size(); ++i) {
        const int node = element.reach()[i];
        const Vector6 on_node = here.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
        work += on_node.head<3>().dot(end[node].position - begin[node].position) +
                on_node.tail<3>().dot(cayley::increment(begin[node].orientation, end[node].orientation));
      }
      const auto energy = [&](const Poses& poses, const std::vector<double>& memory) {
        return element.energy(state_at(poses), memory.data());
      };
      std::vector<double> old(here.memory.size(), 0.0);
      for (std::size_t i = 0; i < old.size(); i += PointMemory::kSize)
        Eigen::Map<Vector3>(old.data() + i + 1) = stretch, old[i + 6] = inside,
                                             Eigen::Map<Vector3>(old.data() + i + 7) = turned;
      EXPECT_GT(here.dissipated, 0);
      EXPECT_GT(here.let_out, 0);
      const double stored = energy(end, here.memory) - energy(begin, old);
      EXPECT_NEAR(work, stored + here.dissipated - here.let_out, 1e-12 * std::abs(work) + 1e-14)
          << name << " " << friction;
    }
}

/// A ball on node 0 in front of a plate of the world. Over a step it moves from one position to another at constant
/// speed.
struct BallAndPlate {
  explicit BallAndPlate(double begin_x, double end_x)
      : begin{node_at(Vector3(begin_x, 0, 0), Quaternion::Identity())},
        end{node_at(Vector3(end_x, 0, 0), Quaternion::Identity())},
        velocities(1, Vector6::Unit(0) * (end_x - begin_x) / 0.05) {
    ContactStation ball;
    ball.radius = 0.02;
    element =
        std::make_unique<ContactElement>(std::vector<std::string>{"ball", "plate"}, ContactStations{{0}, {ball}},
                                         ContactSurface{-1, {{Box{{0.001, 1, 1}}, Pose()}}}, gripping_law(0.3, 1));
  }
  ForceStep step() const {
    ForceStep out{begin, end, velocities};
    out.duration = 0.05;
    return out;
  }

  Poses begin, end;
  std::vector<Vector6> velocities;
  std::unique_ptr<ContactElement> element;
};

/// {force, moment about the world's origin} on the side with the stations, from the residual at rest.
Vector6 pressed(const Eigen::VectorXd& residual, const std::vector<int>& nodes, const Poses& poses) {
  Vector6 out = Vector6::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector6 on_node = -residual.segment<6>(6 * static_cast<Eigen::Index>(i));
    out.head<3>() += on_node.head<3>();
    out.tail<3>() += poses[nodes[i]].position.cross(on_node.head<3>()) + on_node.tail<3>();
  }
  return out;
}

// Without motion, the forces that touch() reports equal those of the residual, moments included. The order of the two
// names only changes signs.
TEST_F(ContactElements, TellWhatTheyDoAndWhere) {
  const State state = state_at(end);
  const std::vector<Vector6> still(4, Vector6::Zero());
  for (const auto& [name, side, surface] : scenes())
    for (const bool is_reversed : {false, true}) {
      const ContactElement element({"", ""}, side, surface, gripping_law(0.05, 0.5), is_reversed);
      const Action rest = action(end, element, end, stretch, true);
      const Vector6 expected = (is_reversed ? -1 : 1) * pressed(rest.residual, side.nodes, end);
      std::vector<double> memory(static_cast<std::size_t>(element.memory_size()), 0.0);
      for (std::size_t i = 0; i < memory.size(); i += PointMemory::kSize)
        Eigen::Map<Vector3>(memory.data() + i + 1) = stretch, Eigen::Map<Vector3>(memory.data() + i + 7) = turned;
      Vector6 sum = Vector6::Zero();
      double deepest = 0;
      const double gap = element.touch({state, still, memory.data()}, [&](const TouchingPoint& point) {
        const Vector3 force = point.push + point.friction;
        sum.head<3>() += force;
        sum.tail<3>() += point.position.cross(force) + point.couple;
        deepest = std::min(deepest, point.gap);
        EXPECT_NEAR(point.normal.norm(), 1, 1e-14);
        EXPECT_GT(point.push.dot(point.normal), 0) << "it pushes the first away";
        EXPECT_LE(point.friction.norm(), 0.05 * point.push.norm() * (1 + 1e-14));
        EXPECT_NEAR(point.friction.dot(point.normal), 0, 1e-14 * point.push.norm());
      });
      EXPECT_GT(expected.norm(), 1) << name;
      EXPECT_LE((sum - expected).norm(), 1e-13 * expected.norm()) << name << surface.node << is_reversed;
      EXPECT_EQ(gap, deepest) << name;
    }
}

// In motion, touch() reports the forces of a short step, with an error proportional to its length: 1e-7 s at 0.2 m/s,
// with penetrations of 0.01 m.
TEST_F(ContactElements, TellWhatTheyDoInMotion) {
  const double duration = 1e-7;
  Poses before = end;
  for (std::size_t i = 0; i < end.size(); ++i) before[i] = moved(end[i], -duration * velocities[i]);
  for (const auto& [name, side, surface] : scenes()) {
    const ContactElement element({"", ""}, side, surface, gripping_law(0.05, 0.5));
    const Action step = action(end, element, before, stretch, false, duration);
    const Vector6 expected = pressed(step.residual, side.nodes, end);
    Vector6 sum = Vector6::Zero();
    element.touch({state_at(end), velocities, step.memory.data()}, [&](const TouchingPoint& point) {
      const Vector3 force = point.push + point.friction;
      sum.head<3>() += force;
      sum.tail<3>() += point.position.cross(force) + point.couple;
    });
    EXPECT_LE((sum - expected).norm(), 1e-4 * expected.norm()) << name << surface.node;
    const Action rest = action(end, element, end, stretch, true);
    EXPECT_GT((pressed(rest.residual, side.nodes, end) - expected).norm(), 2e-3 * expected.norm()) << name << " moves";
  }
}

// The gap is that between the ball's surface and the plate, in contact or not.
TEST(ContactElement, TellsTheSmallestGap) {
  for (const double x : {-0.1, -0.0205}) {
    const BallAndPlate scene(x, x);
    const State state = state_at(scene.begin);
    const double memory[PointMemory::kSize] = {};
    int count = 0;
    const double gap = scene.element->touch({state, scene.velocities, memory}, [&](const TouchingPoint& point) {
      ++count;
      EXPECT_NEAR((point.position - Vector3(x + 0.02, 0, 0)).norm(), 0, 1e-16);
      EXPECT_NEAR((point.normal - Vector3(-1, 0, 0)).norm(), 0, 1e-16);
    });
    EXPECT_NEAR(gap, -x - 0.001 - 0.02, 1e-16);
    EXPECT_EQ(count, x > -0.021);
  }
}

/// A scene with a single station of the given penetration.
Scene alone(const Scene& scene, const ContactStation& station, const Poses& poses, double penetration) {
  const auto pose_of = [&](int node) { return node < 0 ? NodePose() : poses[node]; };
  const Vector3 place = SeenStations(scene.side, scene.surface, pose_of).middle(station);
  Scene out{scene.name, {scene.side.nodes, {station}}, scene.surface};
  out.side.stations[0].radius = scene.surface.shapes[0].gap(place) + penetration;
  return out;
}

// For a touch so light that its force is negligible, the tangent is that of the springs of measures(). The dampers are
// the derivatives of the push with respect to its rate.
TEST_F(ContactElements, HaveTheStiffnessAndDampersOfTheirMeasures) {
  const State state = state_at(end);
  int count = 0;
  for (const Scene& scene : scenes())
    for (const ContactStation& station : scene.side.stations)
      for (const double penetration : {1e-9, 0.1}) {
        const auto& [name, side, surface] = alone(scene, station, end, penetration);
        if (side.stations[0].radius <= 0 || station.rim > 0 || station.half > 0) continue;
        const ContactLaw law = gripping_law(0.5, 0.5);
        const ContactElement element({"", ""}, side, surface, law);
        const std::vector<double> memory(element.memory_size());
        const ForceMeasures measures = element.measures(state, memory.data(), element.reach().data());
        ASSERT_EQ(measures.rows.rows(), 6) << name;
        const double share = side.stations[0].share;
        if (penetration < 1e-6) {
          const Eigen::MatrixXd stiffness = measures.rows.transpose() * measures.stiffness * measures.rows;
          const Action rest = action(end, element, end, Vector3::Zero(), true);
          EXPECT_LE((rest.tangent - stiffness).norm(), 1e-6 * stiffness.norm()) << name << " " << surface.node;
        }
        const double h = 1e-3, v = 1e-6;
        const auto push = [&](double rate) {
          return contact_push(law, {penetration - 0.5 * h * rate, penetration + 0.5 * h * rate, h, 0}).value;
        };
        const double slope = element.dampers(state, memory.data(), Eigen::VectorXd::Zero(6)).slope(0, 0);
        // At a light touch, the contact would end within this difference.
        if (penetration > 1e-6) {
          EXPECT_NEAR(slope, share * (push(v) - push(-v)) / (2 * v), 1e-4 * slope) << name;
        }
        ++count;
      }
  EXPECT_GT(count, 12);
}

// Halved steps are needed if a point passes through a shape or to its other side, or touches a shape that was not near.
TEST(ContactElement, AsksForHalvesOfStepsThatItWouldNotSee) {
  const double memory[PointMemory::kSize] = {};
  const auto asks = [&](double from, double to, int count) {
    const BallAndPlate scene(from, to);
    ForceStep step = scene.step();
    step.memory = memory;
    return scene.element->needs_halves(step, scene.element->reach().data(), count);
  };
  EXPECT_TRUE(asks(-0.1, 0.3, 1)) << "through";
  EXPECT_TRUE(asks(-0.1, 0.005, 1)) << "into it, by its middle";
  EXPECT_TRUE(asks(-0.022, -0.0209, 0)) << "it was not near";
  EXPECT_FALSE(asks(-0.022, -0.0209, 1)) << "a light touch";
  EXPECT_FALSE(asks(-0.1, -0.03, 0));
}

TEST(ContactElement, ActsOnNodesThatAreNearAlone) {
  const auto nodes_in = [](double from, double to) {
    const BallAndPlate scene(from, to);
    int node = -1;
    return scene.element->find_nodes({scene.begin, scene.velocities, 0.05}, &node);
  };
  EXPECT_EQ(nodes_in(-0.1, -0.05), 1) << "twice this way would bring it there";
  EXPECT_EQ(nodes_in(-0.1, -0.09), 0);
  EXPECT_EQ(nodes_in(-0.0211, -0.0211), 1) << "it is there";
}

// A point that starts inside is in contact from its initial depth on. A corner of a box stands on a box of the same
// width: the face on which it can lie counts, although the corner is also on edges of two other faces.
TEST(ContactElement, FeelsWhatStartsInsideFromThereOn) {
  const ContactShape box{Box{{0.5, 0.5, 0.5}}, Pose()};
  Matrix3 below;  // outward directions of a lower corner
  below << 1, 0, 0, 0, 1, 0, 0, 0, -1;
  const auto start_at = [&](double z, double radius, const Matrix3& outwards) {
    return start_inside(box, {}, radius, {0.5, 0.5, z}, outwards);
  };
  EXPECT_EQ(start_at(0.4, 0, below).face, 5);
  EXPECT_NEAR(start_at(0.4, 0, below).start, 0.1, 1e-15);
  EXPECT_EQ(start_at(0.5, 0, below).face, 0) << "it touches";
  EXPECT_EQ(start_at(0.5, 0, below).start, 0) << "it touches";
  EXPECT_EQ(start_at(-0.1, 0, below).face, 0) << "deeper than half the box: of boxes in one place none is above";
  EXPECT_NEAR(start_inside(box, {}, 0.2, {0, 0, 0.6}, Matrix3::Zero()).start, 0.1, 1e-15) << "a ball";
  EXPECT_EQ(start_inside(box, {}, 0.2, {0, 0, 0.7}, Matrix3::Zero()).start, 0) << "a ball that touches";
  const PointMemory nearest = start_inside(box, {}, 0, {0.4, 0, 0.1}, Matrix3::Zero());
  EXPECT_EQ(nearest.face, 1);
  EXPECT_NEAR(nearest.start, 0.1, 1e-15);
}

// When a contact is no longer near, its stored energy is dissipated.
TEST(ContactElement, AccountsForWhatIsRememberedFarAway) {
  const BallAndPlate scene(-0.2, -0.21);
  std::vector<double> memory = {0.3, 0.001, 0.002}, left(PointMemory::kSize, 1.0);
  memory.resize(PointMemory::kSize, 0.0);
  ForceStep step = scene.step();
  step.memory = memory.data();
  step.new_memory = left.data();
  ForceAction action{{nullptr, 0}, {nullptr, 0, 0}};
  scene.element->evaluate(step, nullptr, action);
  EXPECT_NEAR(action.dissipated, 0.5 * 400 * 5e-6, 1e-18);
  EXPECT_EQ(left, std::vector<double>(memory.size(), 0.0));
}

INSTANTIATE_TEST_SUITE_P(Contact, OverSteps, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Rest" : "Means"; });

}  // namespace
}  // namespace flexarm::test
