// Tests the maps of a section that slides along a line of several elements, against exact kinematics, differences and
// complex steps.
#include "joints/slide_map.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "joints/slide_rows.h"

namespace flexarm {
namespace {

using namespace test;

/// Kinds of lines: elements of equal or different order, with the elements' own curve or a smooth one.
struct LineKind {
  int order;  // 0: elements of the orders 3, 2 and 4
  bool smooth;
  friend std::ostream& operator<<(std::ostream& out, const LineKind& kind) {
    return out << (kind.smooth ? "smooth" : "elements") << " of order " << kind.order;
  }
};

/// A line of three elements, 1.5 m long. It is bent and twisted at random at the beginning and at the end of a step.
struct Travel {
  SlideLine line;
  std::vector<NodePose> begin, end;
  double from = 0, to = 0, arm_weight = 0.5;
  SlideAlgorithm algorithm;

  Travel(RandomSource& random, const LineKind& kind, double size) {
    const double borders[] = {0, 0.4, 1.1, 1.5};
    const int mixed[] = {3, 2, 4};
    line.smooth = kind.smooth;
    for (int e = 0, node = 0; e < 3; ++e) {
      const int order = kind.order > 0 ? kind.order : mixed[e];
      line.pieces.push_back({node, order + 1, borders[e], borders[e + 1]});
      node += order;
    }
    for (int i = 0, e = 0; i < line.pieces.back().end_node(); ++i) {
      line.nodes.push_back(i);
      if (i >= line.pieces[e].end_node()) ++e;
      const SlidePiece& piece = line.pieces[e];
      const double xi = node_coordinate(piece.node_count, i - piece.first_node);
      const double x = piece.begin + 0.5 * (1 + xi) * (piece.end - piece.begin);
      NodePose pose;
      pose.position = Vector3(x, 0.3 * x * x, -0.2 * x) + 0.05 * random.vector();
      pose.orientation = random.rotation(0.2) * so3::exp_quaternion(Vector3(0.4 * x, 0, 0.5 * x));
      set(pose);
      begin.push_back(pose);
      pose.position += size * random.vector();
      pose.orientation =
          so3::exp_quaternion(Vector3(size * (Vector3(0.5, -0.7, 1) + 0.3 * random.vector()))) * pose.orientation;
      set(pose);
      end.push_back(pose);
    }
  }
  static void set(NodePose& pose) {
    pose.orientation.normalize();
    pose.rotation = pose.orientation.toRotationMatrix();
  }

  Travel perturbed(int column, double h) const {  // column 0: arc length; then {dr, spin} of the nodes
    Travel out = *this;
    if (column == 0) {
      out.to += h;
      return out;
    }
    NodePose& pose = out.end[(column - 1) / 6];
    const int c = (column - 1) % 6;
    if (c < 3)
      pose.position[c] += h;
    else
      pose.orientation = so3::exp_quaternion(Vector3(h * Vector3::Unit(c - 3))) * pose.orientation;
    set(pose);
    return out;
  }
  SlideTravel travel() const { return {line, begin, end, from, to, algorithm, arm_weight}; }
  void set_step(SlideStep step) { algorithm = {step, step}; }
  SlideMaps maps(const Vector6& g, bool incremental, bool with_tangent = true) const {
    SlideMaps out;
    if (incremental)
      slide_incremental_maps(travel(), g, out, with_tangent);
    else
      slide_variational_maps(line, end, to, g, out, with_tangent);
    return out;
  }
  /// The rows {released row, rows of all nodes of the line}.
  Eigen::VectorXd rows(const Vector6& g, bool incremental) const {
    const SlideMaps m = maps(g, incremental, false);
    Eigen::VectorXd out = Eigen::VectorXd::Zero(1 + 6 * line.nodes.size());
    out[0] = m.released_left.dot(g);
    for (int j = 0; j < m.count; ++j) out.segment<6>(1 + 6 * (m.first + j)) = m.left[j].transpose() * g;
    return out;
  }
};

/// Arc lengths at the beginning and the end: within an element, at a border, over one and two borders, in both
/// directions, and without travel.
const std::pair<double, double> kTravels[] = {
    {0.5, 0.8}, {0.8, 0.5}, {0.3, 0.45},       {0.45, 0.3},       {0.1, 1.3}, {1.3, 0.1},        {0.4, 0.7},
    {0.7, 0.4}, {0.6, 0.6}, {0.6, 0.6 + 1e-7}, {0.4, 0.4 + 1e-9}, {0, 1.5},   {0.399999, 0.4001}};

class SlideMapsOfLine : public ::testing::TestWithParam<LineKind> {};

const SlideStep kSteps[] = {SlideStep::SmEm,     SlideStep::MidContact, SlideStep::EndContact,
                            SlideStep::EnterMid, SlideStep::EnterEnd,   SlideStep::BeginWeights};
const SlideStep kStepsOnTheLine[] = {SlideStep::SmEm, SlideStep::EndContact, SlideStep::EnterEnd,
                                     SlideStep::BeginWeights};

// joints.md 4.3 to 4.5: the maps, applied to the increments of the nodes and Delta X, give exactly the section's
// increments. With the weights of each of these steps this also holds over any border.
TEST_P(SlideMapsOfLine, IncrementsAreMappedExactly) {
  RandomSource random(1);
  for (const SlideStep form : kStepsOnTheLine)
    for (const double size : {0.0, 1e-6, 0.1, 0.6})
      for (const auto& [from, to] : kTravels) {
        Travel step(random, GetParam(), size);
        step.set_step(form);
        step.arm_weight = random.number() < 0 ? 0 : 0.5;
        step.from = from;
        step.to = to;
        const SlideMaps maps = step.maps(Vector6::Zero(), true, false);
        const NodePose before = slide_pose(step.line, step.begin, from), after = slide_pose(step.line, step.end, to);
        Vector6 expected, mapped = (to - from) * maps.released_left;
        expected << after.position - before.position, cayley::increment(before.orientation, after.orientation);
        for (int j = 0; j < maps.count; ++j) {
          const int node = maps.first + j;
          Vector6 increment;
          increment << step.end[node].position - step.begin[node].position,
              cayley::increment(step.begin[node].orientation, step.end[node].orientation);
          mapped += maps.left[j] * increment;
        }
        // For short travels the maps use the curvature in the middle, with an error of third order in a travel of 1e-5.
        EXPECT_LE((mapped - expected).norm(), 2e-14) << size << ": " << from << " to " << to;
      }
}

// joints.md 4.4: with the contact in the middle of the step, the slave's displacement differs from that of the maps.
// The difference is -Delta I^j Delta r_j / 2 within an element. At a border it is the whole travel along the line at
// the beginning. Twice the slave's initial distance from the line is subtracted.
TEST_P(SlideMapsOfLine, ContactInTheMiddleDoesTheWorkOfItsDefect) {
  RandomSource random(7);
  for (const SlideStep form : {SlideStep::MidContact, SlideStep::EnterMid})
    for (const auto& [from, to] : kTravels) {
      Travel step(random, GetParam(), 0.4);
      step.set_step(form);
      step.from = from;
      step.to = to;
      const Vector3 off = 0.01 * random.vector(), r00 = slide_pose(step.line, step.begin, from).position,
                    r01 = slide_pose(step.line, step.end, from).position,
                    r10 = slide_pose(step.line, step.begin, to).position,
                    r11 = slide_pose(step.line, step.end, to).position;
      const SlideMaps maps = step.maps(Vector6::Zero(), true, false);
      Vector3 mapped = (to - from) * maps.released_left.head<3>();
      for (int j = 0; j < maps.count; ++j)
        mapped += maps.left[j](0, 0) * (step.end[maps.first + j].position - step.begin[maps.first + j].position);
      const Vector3 actual = slide_pose(step.travel(), r00 + off).position - (r00 + off);
      const Vector3 defect =
          form == SlideStep::MidContact ? Vector3(-0.5 * (r11 - r10 - r01 + r00)) : Vector3(r10 - r00);
      EXPECT_LE((actual - mapped - defect + 2 * off).norm(), 1e-14) << from << " to " << to;
    }
}

Vector3 mean_arm(const Travel& step, const Vector3& begin, const Vector3& end) {
  return (1 - step.arm_weight) * begin + step.arm_weight * end;
}

/// Expects that the forces of the rows, and their moments about the origin with mean arms, have the same resultant as
/// the slave's residual g at `arm`.
void expect_passed_on(const Travel& step, const Vector6& g, const Vector3& arm) {
  const Eigen::VectorXd rows = step.rows(g, true);
  Vector3 force = -g.head<3>(), moment = -g.tail<3>() - arm.cross(g.head<3>());
  for (std::size_t j = 0; j < step.line.nodes.size(); ++j) {
    const Vector3 f = rows.segment<3>(1 + 6 * j), m = rows.segment<3>(4 + 6 * j);
    force += f;
    moment += m + mean_arm(step, step.begin[j].position, step.end[j].position).cross(f);
  }
  EXPECT_LE(force.norm(), 1e-14);
  EXPECT_LE(moment.norm(), 2e-14) << step.from << " to " << step.to;
}

// Resultant force and moment about the origin, with mean arms, are those of the slave's residual.
TEST_P(SlideMapsOfLine, MomentaArePassedOn) {
  RandomSource random(2);
  for (const auto& [from, to] : kTravels) {
    Travel step(random, GetParam(), 0.5);
    step.arm_weight = random.number() < 0 ? 0 : 0.5;
    step.from = from;
    step.to = to;
    const Vector6 g = random.vector6();
    const Vector3 arm =
        mean_arm(step, slide_pose(step.line, step.begin, from).position, slide_pose(step.line, step.end, to).position);
    expect_passed_on(step, g, arm);
  }
}

// joints.md 4.4: momenta are exact with the contact in the middle, and with the weights and arms of SM2. With the
// contact at the end, the arm has the error e = Delta I^j Delta r_j / 4 within an element. At a border, the error is
// half of the travel along the line at the beginning.
TEST_P(SlideMapsOfLine, AlgorithmsPassOnMomentaAsTheirTablesSay) {
  RandomSource random(6);
  for (const SlideStep form : {SlideStep::MidContact, SlideStep::EndContact, SlideStep::EnterMid, SlideStep::EnterEnd,
                               SlideStep::BeginWeights})
    for (const auto& [from, to] : kTravels) {
      Travel step(random, GetParam(), 0.5);
      step.set_step(form);
      step.from = from;
      step.to = to;
      step.arm_weight = form == SlideStep::BeginWeights ? 0 : 0.5;
      const auto place = [&](const std::vector<NodePose>& nodes, double x) {
        return slide_pose(step.line, nodes, x).position;
      };
      const Vector3 begin = place(step.begin, from) + 0.01 * random.vector();  // the slave may be off the line already
      const bool is_in_middle = form == SlideStep::MidContact || form == SlideStep::EnterMid;
      const Vector3 r_begin = is_in_middle ? begin : place(step.begin, from);
      const Vector3 r_end = slide_pose(step.travel(), r_begin).position;
      if (!is_in_middle) {
        EXPECT_LE((r_end - place(step.end, to)).norm(), 1e-15);
      }
      Vector3 lacking = Vector3::Zero();
      if (form == SlideStep::EndContact)
        lacking =
            0.25 * (place(step.end, to) - place(step.begin, to) - place(step.end, from) + place(step.begin, from));
      if (form == SlideStep::EnterEnd) lacking = -0.5 * (place(step.begin, to) - place(step.begin, from));
      SCOPED_TRACE(static_cast<int>(form));
      expect_passed_on(step, random.vector6(), mean_arm(step, r_begin, r_end) - lacking);
    }
}

TEST_P(SlideMapsOfLine, ColumnsAreTheDerivativeOfTheSection) {
  RandomSource random(3);
  for (const SlideStep form : kSteps)
    for (const auto& [from, to] : {std::pair{0.5, 0.75}, {0.3, 0.75}, {0.3, 1.3}}) {
      Travel step(random, GetParam(), 0.4);
      step.set_step(form);
      step.from = from;
      step.to = to;
      const Vector3 begin = random.vector();
      const SlideMaps maps = step.maps(Vector6::Zero(), true);
      const NodePose pose = slide_pose(step.travel(), begin);
      for (int column = 0; column <= 6 * maps.count; ++column) {
        const int global = column == 0 ? 0 : column + 6 * maps.first;
        const Eigen::VectorXd expected = difference(
            [&](double h) {
              const Travel moved = step.perturbed(global, h);
              const NodePose to = slide_pose(moved.travel(), begin);
              Vector6 change;
              change << to.position, so3::log(Quaternion(to.orientation * pose.orientation.conjugate()));
              return Eigen::VectorXd(change);
            },
            difference_step);
        const Vector6 actual =
            column == 0 ? maps.released_right : Vector6(maps.right[(column - 1) / 6].col((column - 1) % 6));
        EXPECT_LE((actual - expected).norm(), difference_tolerance) << static_cast<int>(form) << ": " << column;
      }
    }
}

TEST_P(SlideMapsOfLine, GeometricBlocksAreTheDerivativeOfTheRows) {
  RandomSource random(4);
  const auto check = [&](const Travel& step, bool incremental) {
    const Vector6 g = random.vector6();
    const SlideMaps maps = step.maps(g, incremental);
    const double size = 0.25;  // size of a rotation over which the rows are smooth: they divide by squares of rotations
    for (int column = 0; column <= 6 * maps.count; ++column) {
      const int global = column == 0 ? 0 : column + 6 * maps.first;
      const Eigen::VectorXd expected =
          difference([&](double h) { return step.perturbed(global, h).rows(g, incremental); }, size * difference_step);
      Eigen::VectorXd actual = Eigen::VectorXd::Zero(expected.size());
      const int j = (column - 1) / 6, c = (column - 1) % 6;
      actual[0] = column == 0 ? maps.released_released : maps.released_master[j][c];
      for (int i = 0; i < maps.count; ++i) {
        const int row = 1 + 6 * (maps.first + i);
        if (column == 0)
          actual.segment<6>(row) = maps.master_released[i];
        else
          actual.segment<3>(row + 3) = maps.moment_master[i * maps.count + j].col(c);
      }
      // Without travel, differences of the rows contain the approximation of short travels, whose error is the square
      // of the difference.
      const double tolerance = (step.from == step.to ? 1e-6 : 10 * difference_tolerance / size) * (1 + expected.norm());
      EXPECT_LE((actual - expected).norm(), tolerance) << incremental << static_cast<int>(step.algorithm.within) << " "
                                                       << step.from << " " << step.to << ": " << column;
    }
  };
  for (const auto& [from, to] : {std::pair{0.5, 0.8}, {0.3, 0.7}, {1.3, 0.1}, {0.6, 0.6}}) {
    Travel step(random, GetParam(), 0.4);
    step.from = from;
    step.to = to;
    check(step, false);
    for (const SlideStep form : kSteps) {
      step.set_step(form);
      step.arm_weight = form == SlideStep::BeginWeights ? 0 : 0.5;
      check(step, true);
    }
    step.set_step(SlideStep::SmEm);
    step.arm_weight = 0;
    check(step, true);
  }
}

// Compares rows and all derivatives with the same formulas in complex arithmetic, to round-off, for any travel.
TEST_P(SlideMapsOfLine, RowsAndDerivativesAgreeWithComplexSteps) {
  RandomSource random(8);
  const auto check = [&](const Travel& step, bool incremental) {
    const Vector6 g = random.vector6();
    const SlideMaps maps = step.maps(g, incremental);
    const SlideRows expected = slide_rows(step.travel(), g, incremental);
    const int count = maps.count;
    ASSERT_EQ(expected.rows.size(), 1 + 6 * count);
    Eigen::VectorXd rows(1 + 6 * count);
    Eigen::MatrixXd derivatives = Eigen::MatrixXd::Zero(1 + 6 * count, 1 + 6 * count);
    rows[0] = maps.released_left.dot(g);
    derivatives(0, 0) = maps.released_released;
    for (int i = 0; i < count; ++i) {
      rows.segment<6>(1 + 6 * i) = maps.left[i].transpose() * g;
      derivatives.block<6, 1>(1 + 6 * i, 0) = maps.master_released[i];
      derivatives.block<1, 6>(0, 1 + 6 * i) = maps.released_master[i].transpose();
      for (int k = 0; k < count; ++k) derivatives.block<3, 6>(4 + 6 * i, 1 + 6 * k) = maps.moment_master[i * count + k];
    }
    // For longer travels, the rotation is divided by the travel, and its derivative by the square of the travel.
    const double travel = std::abs(step.to - step.from), quotient = incremental && travel > 1e-6 ? 1 / travel : 0;
    EXPECT_LE((rows - expected.rows).norm(), 1e-15 * (100 + quotient) * (1 + expected.rows.norm()));
    const double tolerance = 1e-15 * (1000 + quotient * quotient);
    EXPECT_LE((derivatives - expected.derivatives).norm(), tolerance * (1 + expected.derivatives.norm()))
        << incremental << " " << static_cast<int>(step.algorithm.within) << ": " << step.from << " to " << step.to;
  };
  for (const auto& [from, to] : kTravels) {
    Travel step(random, GetParam(), 0.4);
    step.from = from;
    step.to = to;
    check(step, false);
    for (const SlideStep form : kSteps)
      for (const double arm_weight : {0.0, 0.5}) {
        step.set_step(form);
        step.arm_weight = arm_weight;
        check(step, true);
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, SlideMapsOfLine,
                         ::testing::Values(LineKind{1, false}, LineKind{2, false}, LineKind{3, false},
                                           LineKind{4, false}, LineKind{0, false}, LineKind{1, true}, LineKind{2, true},
                                           LineKind{3, true}, LineKind{0, true}));

TEST(SlideLine, PieceAt) {
  RandomSource random(5);
  const SlideLine line = Travel(random, {2, false}, 0).line;
  EXPECT_EQ(line.end(), 1.5);
  EXPECT_EQ(line.overshoot(0.7), 0);
  EXPECT_NEAR(line.overshoot(1.54), 0.1, 1e-14);
  EXPECT_NEAR(line.overshoot(-0.1), 0.25, 1e-14);
  for (const auto& [x, piece] :
       {std::pair{-0.1, 0}, {0.0, 0}, {0.39, 0}, {0.4, 1}, {1.0, 1}, {1.1, 2}, {1.5, 2}, {2.0, 2}})
    EXPECT_EQ(line.piece_at(x), piece) << x;
}

}  // namespace
}  // namespace flexarm
