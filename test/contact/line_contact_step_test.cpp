// Tests contacts with a beam's line over a step: exact work, conservation of momenta, tangents of their forces.
#include "contact/line_contact.h"

#include <gtest/gtest.h>

#include "contact/line_contact_parts.h"
#include "math/cayley.h"
#include "math/shape_functions.h"
#include "math/so3.h"
#include "model/state.h"
#include "support/node_poses.h"

namespace flexarm::test::lines {
namespace {

/// Poses at both ends of a step, velocities, and the contact element. All numbers except the order are random.
struct Scene {
  const char* name;
  std::unique_ptr<LineContact> element;
  Poses begin, end;
  std::vector<Vector6> velocities;
};

/// Adds two elements of a bent line along x to `poses`, and returns the node numbers of both elements.
std::vector<std::array<int, 5>> add_line(int order, double bend, Random& random, Poses& poses) {
  std::vector<std::array<int, 5>> elements(2);
  const int first = static_cast<int>(poses.size());
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i <= order; ++i) {
      elements[k][i] = first + k * order + i;
      if (k == 1 && i == 0) continue;
      const double x = k + 0.5 * (node_coordinate(order + 1, i) - 1);
      poses.push_back(node_at({x, bend * std::sin(2 * x), bend * x * x}, so3::exp_quaternion(random.vector(0.4))));
    }
  return elements;
}

/// Moves and rotates all nodes by random amounts.
Poses moved_by(const Poses& poses, double way, double turn, Random& random) {
  Poses out;
  for (const NodePose& pose : poses) {
    Vector6 by;
    by.head<3>() = random.vector(way);
    by.tail<3>() = random.vector(turn);
    out.push_back(moved(pose, by));
  }
  return out;
}

/// A scene of the given kind: a ball and a point on a body or on the world, stations on another line, or a station on
/// the same line.
Scene scene_of(const char* name, int order, double friction, unsigned seed) {
  Random random(seed);
  Scene out{name, nullptr, {}, {}, {}};
  const std::string kind = name;
  ContactLine line;
  line.order = order;
  line.elements = add_line(order, 0.2, random, out.begin);
  line.lengths = {1, 1};
  line.radius = 0.2;
  ContactStations side;
  std::vector<LinePair> pairs;
  const Vector3 above(0.15, 0.12, 0.32);
  if (kind == "other line") {
    const Poses own = out.begin;
    const std::vector<std::array<int, 5>> elements = add_line(order, -0.1, random, out.begin);
    for (std::size_t i = own.size(); i < out.begin.size(); ++i)
      out.begin[i] =
          node_at(so3::exp(Vector3(0.2, 0.1, 1.1)) * out.begin[i].position + above, out.begin[i].orientation);
    side.nodes.assign(elements[1].begin(), elements[1].begin() + order + 1);
    for (const double xi : {-0.9, -0.6, -0.2}) {
      ContactStation station;
      station.weights = line_weights(order, xi).values;
      station.radius = 0.2;
      station.share = 0.7;
      side.stations.push_back(station);
    }
    pairs = {{0, {}}, {1, {}}, {2, {}}};
  } else if (kind == "same line") {
    side.nodes.assign(line.elements[1].begin(), line.elements[1].begin() + order + 1);
    ContactStation station;
    station.weights = line_weights(order, 0.4).values;
    station.radius = 0.3;
    side.stations = {station};
    pairs = {{0, {0, 1.3}}};  // near its clamped end
  } else {
    ContactStation ball, point;
    ball.arm = {0.1, 0.05, -0.1};
    ball.radius = 0.2;
    point.arm = {0.05, 0.1, -0.24};
    side.stations = {ball, point};
    pairs = {{0, {}}, {1, {}}};
    side.nodes = {-1};
    if (kind == "body") {
      side.nodes = {static_cast<int>(out.begin.size())};
      out.begin.push_back(node_at(above, so3::exp_quaternion(random.vector(0.3))));
    } else {
      for (ContactStation& station : side.stations) station.arm += above;
    }
  }
  out.end = moved_by(out.begin, 0.03, 0.3, random);
  for (std::size_t i = 0; i < out.begin.size(); ++i) {
    Vector6 velocity;
    velocity.head<3>() = random.vector(0.3);
    velocity.tail<3>() = random.vector(0.3);
    out.velocities.push_back(velocity);
  }
  const double crossing = kind == "other line" ? 2 : 0;
  for (LinePair& pair : pairs) pair.tangent = line_weights(order, 0).slopes;
  out.element = std::make_unique<LineContact>(std::vector<std::string>{"", ""}, LineTouch{side, line, pairs, 0},
                                              gripping_law(friction, 0.5), crossing);
  return out;
}

const char* const kNames[] = {"body", "world", "other line", "same line"};

struct Action {
  Eigen::VectorXd residual;
  Eigen::MatrixXd tangent;
  double dissipated = 0, let_out = 0;
  std::vector<int> nodes;
  std::vector<double> memory;
};

const Vector3 kStretch(0.004, -0.003, 0.002);
constexpr double kStiffening = 1.3, kInside = 0.003;

Action action_of(const Scene& scene, const Poses& at_end, bool at_rest) {
  ForceStep step{scene.begin, at_end, scene.velocities};
  step.duration = at_rest ? 0.0 : 0.05;
  step.at_end = at_rest;
  const LineContact& element = *scene.element;
  std::vector<double> memory(element.memory_size(), 0.0);
  for (std::size_t i = 0; i < memory.size(); i += LineMemory::kSize) {
    memory[i] = 0.3;
    Eigen::Map<Vector3>(memory.data() + i + 1) = kStretch;
    memory[i + 4] = kStiffening;
    memory[i + 5] = kInside;
  }
  Action out;
  out.nodes.resize(element.most_nodes());
  out.nodes.resize(element.find_nodes({scene.begin, scene.velocities, 0.05}, out.nodes.data()));
  out.memory.resize(memory.size());
  step.memory = memory.data();
  step.new_memory = out.memory.data();
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(out.nodes.size());
  out.residual.resize(size);
  out.tangent.resize(size, size);
  ForceAction action{{out.residual.data(), size}, {out.tangent.data(), size, size}};
  element.evaluate(step, out.nodes.data(), action);
  out.dissipated = action.dissipated;
  out.let_out = action.work;
  return out;
}

class LineContacts : public ::testing::TestWithParam<bool> {};

// Central differences with the step 1e-6 have truncation errors of 1e-12 times third derivatives, and round-off of
// 1e-16 / 1e-6 times the forces.
TEST_P(LineContacts, HaveTheirTangent) {
  for (const char* name : kNames)
    for (int order = 1; order <= 4; ++order)
      for (const double friction : {0.0, 0.05, 5.0}) {
        const Scene scene = scene_of(name, order, friction, 7);
        const Action here = action_of(scene, scene.end, GetParam());
        EXPECT_GT(here.residual.norm(), 1) << name << order << " is not touched";
        constexpr double h = 1e-6;
        for (Eigen::Index k = 0; k < here.residual.size(); ++k) {
          const auto residual = [&](double way) {
            Vector6 by = Vector6::Zero();
            by[k % 6] = way;
            Poses at = scene.end;
            NodePose& node = at[here.nodes[static_cast<std::size_t>(k / 6)]];
            node = moved(node, by);
            return action_of(scene, at, GetParam()).residual;
          };
          const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
          EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-6 * here.tangent.norm())
              << name << " order " << order << " friction " << friction << " column " << k;
        }
      }
}

TEST_P(LineContacts, AddToNoMomentum) {
  for (const char* name : kNames)
    for (int order = 1; order <= 4; ++order) {
      if (name == std::string("world")) continue;
      const Scene scene = scene_of(name, order, 0.3, 11);
      const Action here = action_of(scene, scene.end, GetParam());
      Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
      const double weight = GetParam() ? 1 : 0.5;
      for (std::size_t i = 0; i < here.nodes.size(); ++i) {
        const int node = here.nodes[i];
        const Vector3 arm = (1 - weight) * scene.begin[node].position + weight * scene.end[node].position;
        const Vector6 on_node = here.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
        force += on_node.head<3>();
        moment += arm.cross(on_node.head<3>()) + on_node.tail<3>();
      }
      EXPECT_GT(here.residual.norm(), 0.1) << name << " is not touched";
      EXPECT_LE(force.norm(), 1e-14 * here.residual.norm()) << name;
      EXPECT_LE(moment.norm(), 1e-13 * here.residual.norm()) << name;
    }
}

// The work of mean forces over the step equals the change of energy plus dissipation, less the work of decaying initial
// penetrations (let_out()), to round-off. This holds for any rotation.
TEST(LineContact, OfMeansDoesExactWork) {
  double let_out = 0;
  for (const char* name : kNames)
    for (int order = 1; order <= 4; ++order)
      for (const double friction : {0.0, 0.01, 0.3, 5.0})
        for (unsigned seed = 1; seed < 20; ++seed) {
          const Scene scene = scene_of(name, order, friction, seed);
          const Action here = action_of(scene, scene.end, false);
          double work = 0;
          for (std::size_t i = 0; i < here.nodes.size(); ++i) {
            const int node = here.nodes[i];
            const Vector6 on_node = here.residual.segment<6>(6 * static_cast<Eigen::Index>(i));
            work +=
                on_node.head<3>().dot(scene.end[node].position - scene.begin[node].position) +
                on_node.tail<3>().dot(cayley::increment(scene.begin[node].orientation, scene.end[node].orientation));
          }
          std::vector<double> old(here.memory.size(), 0.0);
          for (std::size_t i = 0; i < old.size(); i += LineMemory::kSize)
            Eigen::Map<Vector3>(old.data() + i + 1) = kStretch, old[i + 4] = kStiffening, old[i + 5] = kInside;
          const double before = scene.element->energy(state_at(scene.begin), old.data());
          const double behind = scene.element->energy(state_at(scene.end), here.memory.data());
          EXPECT_GE(here.dissipated, 0);
          EXPECT_GE(here.let_out, 0);
          let_out += here.let_out;
          EXPECT_NEAR(work, behind - before + here.dissipated - here.let_out,
                      1e-12 * (std::abs(work) + before + behind))
              << name << " order " << order << " friction " << friction << " seed " << seed;
        }
  EXPECT_GT(let_out, 0);
}

// For a touch so light that its force is negligible, the tangent is that of the springs of measures(). The dampers are
// the derivatives of the push with respect to its rate.
TEST(LineContact, HasTheStiffnessAndDampersOfItsMeasures) {
  for (const char* name : kNames) {
    Scene scene = scene_of(name, 2, 0.5, 3);
    const LineContact* element = scene.element.get();
    const State state = state_at(scene.begin);
    std::vector<int> nodes(element->most_nodes());
    const std::vector<Vector6> at_rest(scene.begin.size(), Vector6::Zero());
    nodes.resize(element->find_nodes({scene.begin, at_rest}, nodes.data()));
    const ForceMeasures measures = element->measures(state, nullptr, nodes.data());
    ASSERT_GE(measures.rows.rows(), 3) << name;
    EXPECT_EQ(measures.rows.cols(), 6 * static_cast<Eigen::Index>(nodes.size()));
    // Each row is the derivative of a gap or of a slip. So a rigid motion of all nodes changes none.
    for (int k = 0; k < 6 && name != std::string("world"); ++k) {
      Eigen::VectorXd motion(measures.rows.cols());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vector3 turn = k < 3 ? Vector3(Vector3::Zero()) : Vector3(Vector3::Unit(k - 3));
        const Vector3 way = k < 3 ? Vector3(Vector3::Unit(k)) : turn.cross(scene.begin[nodes[i]].position);
        motion.segment<6>(6 * static_cast<Eigen::Index>(i)) << way, turn;
      }
      EXPECT_LE((measures.rows * motion).norm(), 1e-13) << name << k;
    }
    // Normal rows: differences of the energy, whose derivative is the push times the row.
    const std::vector<double> memory(element->memory_size(), 0.0);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(measures.rows.cols());
    constexpr double h = 1e-6;
    for (Eigen::Index k = 0; k < slope.size(); ++k) {
      const auto energy = [&](double way) {
        Poses at = scene.begin;
        Vector6 by = Vector6::Zero();
        by[k % 6] = way;
        NodePose& node = at[nodes[static_cast<std::size_t>(k / 6)]];
        node = moved(node, by);
        return element->energy(state_at(at), memory.data());
      };
      slope[k] = (energy(h) - energy(-h)) / (2 * h);
    }
    // The derivative is a combination of the normal rows. With another line it is not, because the energy depends on
    // the crossing angle.
    if (name != std::string("other line")) {
      Eigen::MatrixXd rows(measures.rows.rows() / 3, measures.rows.cols());
      for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = measures.rows.row(3 * i);
      const Eigen::VectorXd pushes = rows.transpose().colPivHouseholderQr().solve(slope);
      EXPECT_LE((rows.transpose() * pushes - slope).norm(), 1e-7 * slope.norm()) << name;
      EXPECT_LT(pushes.maxCoeff(), 0) << name << ": energies rise as gaps close";
    }
    const DamperTensions dampers = element->dampers(state, nullptr, Eigen::VectorXd::Ones(measures.rows.rows()));
    EXPECT_GT(dampers.tension[0], 0);
    EXPECT_EQ(dampers.tension[1], 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Contact, LineContacts, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Rest" : "Means"; });

}  // namespace
}  // namespace flexarm::test::lines
