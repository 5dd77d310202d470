// The planar kernel of the energy-momentum family is that of three dimensions, seen in the plane.
#include "elements/planar_beam.h"
#include "elements/conserving_kernel.h"
#include "elements/kernel_checks.h"
#include "model/plane.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kStep = 0.3;
/// Sums of some hundred terms, relative to the largest: round-off.
constexpr double kRoundOff = 1e-13;

struct Options {
  bool is_corrected, is_damped;
  MidFunctions mid = MidFunctions::Explicit;
  int dissipation_order = 0;
  double size = 0.5;  // of the step

  TimeRule rule() const { return time_rule(is_corrected, mid, dissipation_order, kStep); }
};

const Options kOptions[] = {{true, false},
                            {true, true},
                            {false, true},
                            {true, false, MidFunctions::Explicit, 0, 1e-3},
                            {true, false, MidFunctions::Symmetric},
                            {true, true, MidFunctions::Explicit, 2}};

/// A step of a curved element with a full section, all in one plane that lies anyhow.
template <int Nodes>
struct PlanarStep {
  using Element = BeamElement<Nodes>;

  PlanarStep(RandomSource& random, const Options& options) : options(options), rule(options.rule()) {
    const Matrix3 axes = random.rotation(3.0).toRotationMatrix();
    plane.first = axes.col(0), plane.second = axes.col(1), plane.normal = axes.col(2);
    height = random.number();
    const Quaternion frame = random.rotation(3.0);
    plane.frames.assign(Nodes, frame);
    basis = plane.strain_basis(0);
    RandomStep<Nodes> any(random, 0.1);  // for its shape functions
    element = any.element;
    for (auto& point : element.stiffness_points) {
      const Eigen::Matrix<double, 6, 3> rest = basis_out_of_plane();
      point.stiffness = basis * random.positive_definite<3>() * basis.transpose() +
                        rest * random.positive_definite<3>() * rest.transpose();
      point.reference_strain = basis * random.vector();
    }
    if (options.is_damped) element.stiffness_damping = element.mass_damping = 0.2;
    for (int i = 0; i < Nodes; ++i) {
      begin_angle[i] = 2 + 0.4 * random.number();
      end_angle[i] = begin_angle[i] + options.size * (1 + 0.5 * random.number());
      begin[i] = {1.5 * i / (Nodes - 1) + 0.1 * random.number(), 0.3 * random.number()};
      end[i] = begin[i] + options.size * Vector2(random.number(), random.number());
      velocity[i] = {random.number(), random.number()};
      foreseen[i] = options.mid == MidFunctions::Explicit ? options.size * random.number() : 0.0;
    }
    for (StrainMemory& m : memory) m = {basis * random.vector(), basis * random.vector(), basis * random.vector()};
  }

  /// Columns of the other strains.
  Eigen::Matrix<double, 6, 3> basis_out_of_plane() const {
    Eigen::Matrix<double, 6, 3> rest = Eigen::Matrix<double, 6, 3>::Zero();
    rest.col(0).template head<3>() = plane.material_normal(0);
    rest.col(1).template tail<3>() = basis.col(0).template head<3>();
    rest.col(2).template tail<3>() = basis.col(1).template head<3>();
    return rest;
  }
  Vector3 in_space(const Vector2& v, double height = 0) const {
    return v[0] * plane.first + v[1] * plane.second + height * plane.normal;
  }
  Quaternion turned(double angle) const { return so3::exp_quaternion(Vector3(angle * plane.normal)) * plane.frames[0]; }
  double increment(int i) const { return 2 * std::tan(0.5 * (end_angle[i] - begin_angle[i])); }

  /// By the kernel of three dimensions: {f_1, f_2, phi} and blocks of the nodes.
  ElementSystem<Nodes> in_three_dimensions(bool with_tangent) {
    KernelData<Nodes, double> data;
    std::array<Quaternion, Nodes> begin_orientation;
    std::array<Vector3, Nodes> turns;
    ElementNodes<Nodes> nodes;
    for (int i = 0; i < Nodes; ++i) {
      nodes.begin[i] = in_space(begin[i], height);
      nodes.end[i] = in_space(end[i], height);
      nodes.orientation[i] = turned(end_angle[i]);
      nodes.increment[i] = increment(i) * plane.normal;
      nodes.velocity[i] = in_space(velocity[i]);
      begin_orientation[i] = turned(begin_angle[i]);
      turns[i] = foreseen[i] * plane.normal;
    }
    ConservingElement<Nodes> constants;
    set_lane(constants, 0, element);
    ElementFunctions<Nodes> functions;
    mid_functions<Nodes, double>(constants, begin_orientation, turns, functions);
    if (options.is_corrected) stretch_mid_functions<Nodes, double>(turns, functions);
    std::array<flexarm::PointKinematics, Nodes - 1> points;
    element_points<Nodes, double>(constants, nodes.begin, begin_orientation, points.data());
    data.set(0, {element, nodes, functions, points.data(), memory.data()});
    flexarm::CarriedStrains<Nodes> carried;
    if (is_carried) {
      for (int k = 0; k < Nodes - 1; ++k)
        carried.end[k] = basis * carried_end, carried.conjugate[k] = basis * carried_s;
      carried.has_conjugate = true;
      data.carried = &carried;
    }
    data.evaluate(rule, kStep, with_tangent);
    ElementSystem<Nodes> out;
    data.get(0, with_tangent, out);
    if (is_carried)
      for (int i = 0; i < Nodes; ++i) out.carried.template segment<6>(6 * i) = data.system.carried[i];
    data.get_end(0, end_points.data(), end_memory.data());
    return out;
  }

  planar::BlockSystem<Nodes> in_plane(bool with_tangent) {
    planar::Element<Nodes> constants;
    planar::set_lane(constants, 0, element, basis);
    planar::Nodal<Nodes> nodes;
    std::array<double, Nodes> cosine, sine;
    double mean = 0;
    for (int i = 0; i < Nodes; ++i) {
      const PlanarPose first = plane.pose(i, in_space(begin[i], height), turned(begin_angle[i])),
                       last = plane.pose(i, in_space(end[i], height), turned(end_angle[i]));
      nodes.begin[i] = {first.x, first.y}, nodes.end[i] = {last.x, last.y};
      cosine[i] = first.cosine, sine[i] = first.sine;
      nodes.cosine[i] = last.cosine, nodes.sine[i] = last.sine;
      nodes.increment[i] = increment(i);
      nodes.velocity[i] = velocity[i];
      mean += foreseen[i] / Nodes;
    }
    const double slope = options.is_corrected ? 1 / (1 + 0.25 * mean * mean) : 1.0;
    std::array<planar::PointKinematics<double>, Nodes - 1> points;
    planar::set_points<Nodes, double>(constants, nodes.begin, cosine, sine, points.data());
    std::array<planar::StrainMemory<double>, Nodes - 1> memories;
    for (int k = 0; k < Nodes - 1; ++k)
      memories[k] = {basis.transpose() * memory[k].average, basis.transpose() * memory[k].rate,
                     basis.transpose() * memory[k].delayed_rate};
    planar::CarriedStrains<Nodes> carried;
    carried.end.fill(carried_end), carried.conjugate.fill(carried_s);
    carried.has_conjugate = true;
    planar::BlockSystem<Nodes> system;
    planar::beam<Nodes, double>(constants, slope, nodes, rule, points.data(), memories.data(), kStep, with_tangent,
                                is_carried ? &carried : nullptr, planar_points.data(), planar_memory.data(), system);
    return system;
  }

  /// Node i moved along {dx, dy, spin}.
  PlanarStep moved(int i, int component, double by) const {
    PlanarStep out = *this;
    if (component == 2)
      out.end_angle[i] += by;
    else
      out.end[i][component] += by;
    return out;
  }

  Options options;
  TimeRule rule;
  PlaneOfMotion plane;
  double height;
  Eigen::Matrix<double, 6, 3> basis;
  Element element;
  std::array<double, Nodes> begin_angle, end_angle, foreseen;
  std::array<Vector2, Nodes> begin, end, velocity;
  std::array<StrainMemory, Nodes - 1> memory, end_memory;
  std::array<flexarm::PointKinematics, Nodes - 1> end_points;
  std::array<planar::StrainMemory<double>, Nodes - 1> planar_memory;
  std::array<planar::PointKinematics<double>, Nodes - 1> planar_points;
  bool is_carried = false;
  Vector3 carried_end = {0.1, -0.2, 0.3}, carried_s = {0.2, 0.05, -0.1};
};

template <class Count>
class PlanarBeam : public ::testing::Test {};
TYPED_TEST_SUITE(PlanarBeam, NodeCounts);

TYPED_TEST(PlanarBeam, IsTheKernelOfThreeDimensionsSeenInThePlane) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  for (const Options& options : kOptions)
    for (const bool is_carried : {false, true}) {
      PlanarStep<N> step(random, options);
      step.is_carried = is_carried;
      const ElementSystem<N> space = step.in_three_dimensions(true);
      const planar::BlockSystem<N> plane = step.in_plane(true);
      // The energy multiplier divides round-off of the work by relative turns, its derivative by their squares.
      const double turn = options.is_corrected ? 0.5 * options.size : 1.0;
      const double scale = std::max(largest(space.residual), 1.0) / turn,
                   slope = largest(space.tangent) / (turn * turn);
      for (int i = 0; i < N; ++i) {
        const Vector6 expected = space.residual.template segment<6>(6 * i);
        EXPECT_LE(largest(step.plane.projected(expected) - plane.residual[i].template head<3>()), kRoundOff * scale);
        EXPECT_LE(largest(expected - step.plane.expanded(step.plane.projected(expected))), kRoundOff * scale);
        if (is_carried) {
          const Vector6 carried = space.carried.template segment<6>(6 * i);
          EXPECT_LE(largest(step.plane.projected(carried) - plane.carried[i].template head<3>()), kRoundOff * slope);
        }
        for (int j = 0; j < N; ++j) {
          const Matrix6 block = space.tangent.template block<6, 6>(6 * i, 6 * j);
          for (int c = 0; c < 3; ++c) {
            const Vector6 column = block * step.plane.expanded(Vector3(Vector3::Unit(c)));
            EXPECT_LE(largest(step.plane.projected(column) - plane.tangent[i][j].col(c).template head<3>()),
                      kRoundOff * slope);
            EXPECT_LE(largest(column - step.plane.expanded(step.plane.projected(column))), kRoundOff * slope);
          }
        }
      }
      EXPECT_NEAR(space.dissipated, plane.dissipated, kRoundOff * std::max(1.0, std::abs(space.dissipated)));
      for (int k = 0; k < N - 1; ++k) {
        const Vector6 strain = step.basis * step.planar_points[k].strain;
        EXPECT_LE(largest(strain - step.end_points[k].strain), kRoundOff * 10);
        if (options.dissipation_order > 0) {
          EXPECT_LE(largest(step.basis * step.planar_memory[k].average - step.end_memory[k].average), kRoundOff * 10);
          EXPECT_LE(largest(step.basis * step.planar_memory[k].rate - step.end_memory[k].rate), kRoundOff * 100);
        }
      }
    }
}

TYPED_TEST(PlanarBeam, HasTheTangentOfItsResidual) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  for (const Options& options : kOptions) {
    PlanarStep<N> step(random, options);
    const planar::BlockSystem<N> system = step.in_plane(true);
    double scale = 1;
    for (const auto& row : system.tangent)
      for (const auto& block : row) scale = std::max(scale, largest(block));
    const double size = std::min(1.0, options.size);
    for (int j = 0; j < N; ++j)
      for (int c = 0; c < 3; ++c) {
        using Column = Eigen::Matrix<double, 3 * N, 1>;
        const Column expected = difference(
            [&](double h) {
              PlanarStep<N> moved = step.moved(j, c, h);
              const planar::BlockSystem<N> at = moved.in_plane(false);
              Column column;
              for (int i = 0; i < N; ++i) column.template segment<3>(3 * i) = at.residual[i].template head<3>();
              return column;
            },
            difference_step * size);
        for (int i = 0; i < N; ++i)
          EXPECT_LE(largest(expected.template segment<3>(3 * i) - system.tangent[i][j].col(c).template head<3>()),
                    difference_tolerance / size * scale);
      }
  }
}

}  // namespace
}  // namespace flexarm
