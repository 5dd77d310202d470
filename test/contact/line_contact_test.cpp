// Tests contacts with a beam's line over a step: exact work, conservation of momenta, tangents of their forces.
#include "contact/line_contact.h"

#include <random>

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/shape_functions.h"
#include "math/so3.h"
#include "model/state.h"
#include "support/gripping_law.h"
#include "support/node_poses.h"

namespace flexarm::test::lines {
namespace {

using Poses = std::vector<NodePose>;

ContactLaw gripping_law(double friction, double restitution) {
  return test::gripping_law(friction, restitution, 0.4);
}

/// Poses at both ends of a step, velocities, and the contact element. All numbers except the order are random.
struct Scene {
  const char* name;
  std::unique_ptr<LineContact> element;
  Poses begin, end;
  std::vector<Vector6> velocities;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Braces guarantee that the numbers are drawn in the same order with every compiler.
  Vector3 vector(double size) { return size * Vector3{number_(engine_), number_(engine_), number_(engine_)}; }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> number_{-1, 1};
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

// ---------------------------------------------------------------- nearest places, and search for near pairs

TEST(LineContact, FindsTheNearestPlaceOfALine) {
  Random random(5);
  for (int order = 1; order <= 4; ++order)
    for (int run = 0; run < 200; ++run) {
      std::array<Vector3, 5> nodes;
      for (int i = 0; i <= order; ++i) nodes[i] = Vector3(node_coordinate(order + 1, i), 0, 0) + random.vector(0.15);
      const Vector3 point = random.vector(1.5);
      const LinePiece piece = line_piece(order, nodes);
      const double low = run % 2 ? -1 : -0.3, high = run % 3 ? 1 : 0.4;
      const ClosestPoint found = closest_point(piece, point, low, high);
      const auto distance_at = [&](double xi) {
        const ElementWeights weights = line_weights(order, xi).values;
        Vector3 at = -point;
        for (int i = 0; i <= order; ++i) at += weights[i] * nodes[i];
        return at.norm();
      };
      EXPECT_NEAR(std::sqrt(found.square), distance_at(found.xi), 1e-14);
      for (int k = 0; k <= 300; ++k)
        EXPECT_GE(distance_at(low + (high - low) * k / 300), std::sqrt(found.square) - 1e-13) << order << " " << run;
      // The distance is stationary at the nearest point, so the point is as exact as the derivative.
      if (!found.is_clamped && found.square > 1e-4) {
        const double h = 1e-4, slope = (distance_at(found.xi + h) - distance_at(found.xi - h)) / (2 * h);
        EXPECT_LE(std::abs(slope), 1e-6) << order << " " << run;
      }
      EXPECT_LE((piece.middle() - nodes[0]).norm(), piece.reach + 1e-14);
      EXPECT_LE(piece.least_distance(point), std::sqrt(found.square) + 1e-14);
    }
}

/// A small ball beside a line of ten elements of order 1 along x. Over a step it moves from one position to another at
/// constant speed.
struct BallAndLine {
  BallAndLine(const Vector3& from, const Vector3& to) {
    LineTouch touch;
    for (int i = 0; i <= 10; ++i) begin.push_back(node_at({0.1 * i, 0, 0}, Quaternion::Identity()));
    touch.line.order = 1;
    for (int i = 0; i < 10; ++i) {
      touch.line.elements.push_back({i, i + 1});
      touch.line.lengths.push_back(0.1);
    }
    touch.line.radius = 0.001;
    end = begin;
    begin.push_back(node_at(from, Quaternion::Identity()));
    end.push_back(node_at(to, Quaternion::Identity()));
    velocities.assign(begin.size(), Vector6::Zero());
    velocities.back().head<3>() = (to - from) / 0.05;
    ContactStation ball;
    ball.radius = 0.02;
    touch.side = {{11}, {ball}};
    touch.pairs = {{0, {}, {}}};
    element = std::make_unique<LineContact>(std::vector<std::string>{"", ""}, touch, gripping_law(0, 1));
  }
  std::vector<int> near() const {
    std::vector<int> nodes(element->most_nodes());
    nodes.resize(element->find_nodes({begin, velocities, 0.05}, nodes.data()));
    return nodes;
  }
  bool asks_for_halves(bool was_near) const {
    const double memory[LineMemory::kSize] = {};
    ForceStep step{begin, end, velocities};
    step.duration = 0.05;
    step.memory = memory;
    const std::vector<int> nodes = near();
    return element->needs_halves(step, nodes.data(), was_near ? static_cast<int>(nodes.size()) : 0);
  }

  Poses begin, end;
  std::vector<Vector6> velocities;
  std::unique_ptr<LineContact> element;
};

TEST(LineContact, ActsOnNodesThatAreNearAlone) {
  const Vector3 at(0.55, 0, 0.1);
  EXPECT_EQ(BallAndLine(at, at).near(), std::vector<int>());
  EXPECT_EQ(BallAndLine(at, at - Vector3(0, 0, 0.03)).near(), std::vector<int>()) << "twice this way: not yet";
  EXPECT_EQ(BallAndLine(at, at - Vector3(0, 0, 0.045)).near(), (std::vector<int>{11, 5, 6}));
  EXPECT_EQ(BallAndLine({0.602, 0, 0.021}, {0.602, 0, 0.021}).near(), (std::vector<int>{11, 6, 7, 5}));
}

TEST(LineContact, AsksForHalvesOfStepsThatItWouldNotSee) {
  const auto asks = [](double from, double to, bool was_near) {
    return BallAndLine({0.55, 0, from}, {0.55, 0, to}).asks_for_halves(was_near);
  };
  EXPECT_TRUE(asks(0.1, -0.3, true)) << "through";
  EXPECT_TRUE(asks(0.022, -0.015, true)) << "to the other side, still inside";
  EXPECT_TRUE(asks(0.0215, 0.0205, false)) << "it was not near";
  EXPECT_FALSE(asks(0.0215, 0.0209, true)) << "a light touch";
  EXPECT_FALSE(asks(0.1, 0.03, false));
  EXPECT_FALSE(BallAndLine({0.55, 0.03, 0.1}, {0.55, 0.03, -0.1}).asks_for_halves(true)) << "beside it";
  const auto grazes = [](double y, double z) { return BallAndLine({0.55, y, z}, {0.55, -y, z}).asks_for_halves(true); };
  EXPECT_TRUE(grazes(1.1e-3, 0.02098)) << "by its way it goes in by a thousandth";
  EXPECT_FALSE(grazes(1e-6, 0.021 - 1e-11)) << "round-off: what lies alongside would be halved for ever";
}

/// A line of elements of order 1 along x, 0.1 m long each, and two balls a half metre apart, at a node or in the world.
struct TwoBallsAndLine {
  TwoBallsAndLine(bool is_body, const Vector3& middle, const Vector3& arm) {
    LineTouch touch;
    constexpr int kElements = 60;
    for (int i = 0; i <= kElements; ++i) poses.push_back(node_at({0.1 * i, 0, 0}, Quaternion::Identity()));
    touch.line.order = 1;
    for (int i = 0; i < kElements; ++i) touch.line.elements.push_back({i, i + 1});
    touch.line.lengths.assign(kElements, 0.1);
    touch.line.radius = 0.01;
    if (is_body) poses.push_back(node_at(middle, Quaternion::Identity()));
    touch.side.nodes = {is_body ? kElements + 1 : -1};
    for (const double x : {-0.25, 0.25}) {
      ContactStation ball;
      ball.arm = arm + Vector3(x, 0, 0) + (is_body ? Vector3(Vector3::Zero()) : middle);
      ball.radius = 0.02;
      touch.pairs.push_back({static_cast<int>(touch.side.stations.size()), {}, {}});
      touch.side.stations.push_back(ball);
    }
    element = std::make_unique<LineContact>(std::vector<std::string>{"", ""}, touch, gripping_law(0.1, 0.5));
  }

  Poses poses;
  std::unique_ptr<LineContact> element;
};

// The nodes of small motions are those that the stations touch, wherever stations are relative to their node or to the
// world's origin, and however many elements are between them.
TEST(LineContact, MeasuresTheStationsThatTouch) {
  for (const bool is_body : {true, false})
    for (const Vector3& arm : {Vector3(0, 0, 0), Vector3(-3, 0, 0), Vector3(0, 2, 1)}) {
      const TwoBallsAndLine scene(is_body, Vector3(3.05, 0, 0.029) - arm, arm);
      const State state = state_at(scene.poses);
      std::vector<int> nodes(scene.element->most_nodes());
      const std::vector<Vector6> at_rest(scene.poses.size(), Vector6::Zero());
      nodes.resize(scene.element->find_nodes({scene.poses, at_rest}, nodes.data()));
      const ForceMeasures measures = scene.element->measures(state, nullptr, nodes.data());
      ASSERT_EQ(measures.rows.rows(), 6) << is_body << arm.transpose();
      ASSERT_EQ(measures.rows.cols(), 6 * static_cast<Eigen::Index>(nodes.size()));
      // The balls are over the line's nodes 28 and 33, so each normal measure is the height over one of these.
      for (const auto& [row, below] : {std::pair<Eigen::Index, int>(0, 28), {3, 33}}) {
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(measures.rows.cols());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const auto at = 6 * static_cast<Eigen::Index>(i);
          if (nodes[i] == below) expected[at + 2] = -1;
          if (nodes[i] == 61) {
            expected[at + 2] = 1;
            expected.segment<3>(at + 3) = (arm + Vector3(row == 0 ? -0.25 : 0.25, 0, 0)).cross(Vector3::UnitZ());
          }
        }
        EXPECT_LE((measures.rows.row(row).transpose() - expected).norm(), 1e-12) << is_body << arm.transpose();
      }
      const DamperTensions dampers = scene.element->dampers(state, nullptr, Eigen::VectorXd::Ones(6));
      EXPECT_GT(dampers.tension[0], 0);
      EXPECT_GT(dampers.tension[3], 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Contact, LineContacts, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Rest" : "Means"; });

}  // namespace
}  // namespace flexarm::test::lines
