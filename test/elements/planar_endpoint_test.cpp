// The planar kernel of Newmark's family is that of three dimensions, seen in the plane.
#include "elements/planar_endpoint.h"
#include "elements/endpoint_beam.h"
#include "elements/random_planar_step.h"
#include "elements/rotary_inertia.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

struct EndpointOptions {
  bool is_damped = false, is_uneven = false;
  double alpha = 0;           // strains are those of another instant than the accelerations
  double internal_slope = 1;  // internal forces are interpolated in time
};

const EndpointOptions kEndpointOptions[] = {{}, {true}, {true, true}, {true, false, -0.1}, {true, false, 0, 0.7}};

template <int Nodes>
struct EndpointStep : RandomPlanarStep<Nodes> {
  using Base = RandomPlanarStep<Nodes>;

  EndpointStep(RandomSource& random, const EndpointOptions& options) : Base(random, 0.5), options(options) {
    balance.rule = {0.3025, 0.6, kStep, options.alpha};
    balance.internal_slope = options.internal_slope;
    balance.interpolates_damping = options.alpha == 0;
    if (options.is_damped) this->element.stiffness_damping = this->element.mass_damping = 0.2;
    if (options.is_uneven) {  // principal axes of the damping are those of the section: along the plane's
      this->plane.frames.assign(Nodes, Quaternion(this->axes()));
      this->basis = this->plane.strain_basis(0);
      this->element.damping_scale << 1, 0.7, 0.2, 0.9, 0.3, 0.5;
      for (auto& point : this->element.stiffness_points) {
        set_along_axes(point);
        point.reference_strain = this->basis * random.vector();
      }
      for (auto& point : this->element.mass_points) point.inertia = Vector3(0.3, 0.2, 0.5).asDiagonal();
    }
    for (int i = 0; i < Nodes; ++i) {
      acceleration[i] = Base::in_order(random);
      mass_points[i] = {random.number() * normal(), random.number() * normal()};
    }
    for (Vector6& rate : strain_rates) rate = this->basis * random.vector();
    for (Vector3& strain : carried) strain = random.vector();
  }

  Matrix3 axes() const {
    Matrix3 axes;
    axes << this->plane.first, this->plane.second, this->plane.normal;
    return axes;
  }
  /// Sections whose axes are those of the plane: {Gamma_1, Gamma_2, K_3} and the others apart.
  static void set_along_axes(typename BeamElement<Nodes>::StiffnessPoint& point) {
    Matrix6 stiffness = Vector6(3, 2, 2.5, 1.2, 1.5, 2.2).asDiagonal();
    stiffness(0, 5) = stiffness(5, 0) = 0.3;
    stiffness(3, 4) = stiffness(4, 3) = 0.2;
    point.stiffness = stiffness;
  }
  Vector3 normal() const { return this->plane.material_normal(0); }
  double turn(int i) const { return this->end_angle[i] - this->begin_angle[i]; }

  ElementNodes<Nodes> nodes_in_space(bool at_end) const {
    ElementNodes<Nodes> nodes;
    for (int i = 0; i < Nodes; ++i) {
      nodes.begin[i] = this->in_space(this->begin[i], this->height);
      nodes.end[i] = at_end ? this->in_space(this->end[i], this->height) : nodes.begin[i];
      nodes.orientation[i] = this->turned(at_end ? this->end_angle[i] : this->begin_angle[i]);
      nodes.velocity[i] = this->in_space(this->velocity[i]);
      nodes.acceleration[i] = this->in_space(acceleration[i]);
    }
    return nodes;
  }

  /// All forces, and their tangent as it goes into the balance.
  ElementSystem<Nodes> in_three_dimensions() {
    const NewmarkRule& rule = balance.rule;
    const ElementNodes<Nodes> nodes = nodes_in_space(true), before = nodes_in_space(false);
    std::array<flexarm::PointKinematics, Nodes - 1> begin_points;
    std::array<Vector6, Nodes - 1> rest_rates;
    ElementSystem<Nodes> unused, internal, inertia;
    for (ElementSystem<Nodes>* system : {&unused, &internal, &inertia}) system->set_zero();
    endpoint_internal<Nodes>(this->element, before, nullptr, nullptr, nullptr, false, begin_points.data(),
                             rest_rates.data(), unused);
    std::array<Vector6, Nodes - 1> seen;
    for (int k = 0; k < Nodes - 1; ++k) seen[k] = this->basis * carried[k];
    endpoint_internal<Nodes>(this->element, nodes, &rule, begin_points.data(), strain_rates.data(), true,
                             end_points.data(), end_rates.data(), internal, is_carried ? seen.data() : nullptr);
    newmark_mass_damping<Nodes>(this->element, nodes, rule, true, balance.interpolates_damping ? internal : inertia);
    newmark_translation<Nodes>(this->element, nodes, rule, true, inertia);
    std::array<Matrix3, Nodes> begin_rotations;
    for_each_mass_point<Nodes>(this->element, before, false,
                               [&](int k, const auto& point, const auto&) { begin_rotations[k] = point.rotation; });
    for_each_mass_point<Nodes>(
        this->element, nodes, true, [&](int k, const auto& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
          const RotaryRate rate = newmark_rotary_rate(this->element.mass_points[k].inertia, begin_rotations[k],
                                                      point.rotation, mass_points[k], rule);
          end_motion[k] = rate.end;
          add_rotary_rate(this->element, k, rate, generalised, true, inertia);
        });
    internal.carried *= balance.internal_slope;
    internal.tangent = (balance.internal_slope * internal.tangent + inertia.tangent).eval();
    internal.residual += inertia.residual;
    internal.dissipated += inertia.dissipated;
    return internal;
  }

  planar::BlockSystem<Nodes> in_plane(bool with_tangent, std::array<Vector3, Nodes>& forces) {
    const NewmarkRule& rule = balance.rule;
    planar::Element<Nodes> constants;
    planar::RotaryElement<Nodes> rotary;
    planar::set_lane(constants, 0, this->element, this->basis);
    planar::set_lane(rotary, 0, this->element, normal());
    planar::EndpointNodal<Nodes> nodes;
    planar::EndpointMemory<Nodes> begin;
    std::array<Vector2, Nodes> positions;
    std::array<double, Nodes> cosine, sine;
    for (int i = 0; i < Nodes; ++i) {
      const PlanarPose first = this->pose(this->begin[i], this->begin_angle[i]),
                       last = this->pose(this->end[i], this->end_angle[i]);
      positions[i] = {first.x, first.y}, cosine[i] = first.cosine, sine[i] = first.sine;
      nodes.position[i] = {last.x, last.y}, nodes.cosine[i] = last.cosine, nodes.sine[i] = last.sine;
      nodes.turn[i] = turn(i);
      nodes.displacement[i] = this->end[i] - this->begin[i];
      nodes.acceleration[i] = rule.acceleration<Vector2>(nodes.displacement[i], this->velocity[i], acceleration[i]);
      const Vector2 velocity = rule.velocity<Vector2>(this->velocity[i], acceleration[i], nodes.acceleration[i]);
      nodes.damped_velocity[i] = (1 + rule.alpha) * velocity - rule.alpha * this->velocity[i];
      begin.rotary[i] = rule.acceleration<double>(0, normal().dot(mass_points[i].angular_velocity),
                                                  normal().dot(mass_points[i].angular_acceleration));
    }
    planar::set_points<Nodes, double>(constants, positions, cosine, sine, begin.points.data());
    for (int k = 0; k < Nodes - 1; ++k) begin.strain_rates[k] = this->basis.transpose() * strain_rates[k];
    planar::BlockSystem<Nodes> system;
    std::array<Eigen::Vector4d, Nodes> inertia;
    planar::endpoint_beam<Nodes, double>(constants, rotary, nodes, balance, begin, with_tangent,
                                         is_carried ? &carried : nullptr, result, system, inertia);
    for (int i = 0; i < Nodes; ++i) forces[i] = (system.residual[i] + inertia[i]).template head<3>();
    return system;
  }

  EndpointOptions options;
  planar::EndpointBalance balance;
  std::array<Vector2, Nodes> acceleration;
  std::array<MassPointState, Nodes> mass_points, end_motion;
  std::array<Vector6, Nodes - 1> strain_rates, end_rates;
  std::array<flexarm::PointKinematics, Nodes - 1> end_points;
  planar::EndpointResult<Nodes> result;
  std::array<Vector3, Nodes - 1> carried;
  bool is_carried = false;
};

template <class Count>
class PlanarEndpoint : public ::testing::Test {};
TYPED_TEST_SUITE(PlanarEndpoint, NodeCounts);

TYPED_TEST(PlanarEndpoint, IsTheKernelOfThreeDimensionsSeenInThePlane) {
  constexpr int N = TypeParam::value;
  RandomSource random(17);
  for (const EndpointOptions& options : kEndpointOptions)
    for (const bool is_carried : {false, true}) {
      EndpointStep<N> step(random, options);
      step.is_carried = is_carried;
      const ElementSystem<N> space = step.in_three_dimensions();
      std::array<Vector3, N> forces;
      const planar::BlockSystem<N> plane = step.in_plane(true, forces);
      const double scale = std::max(largest(space.residual), 1.0), slope = std::max(largest(space.tangent), 1.0);
      expect_same_in_plane<N>(step.plane, space, forces, plane, kPlanarRoundOff * slope, kPlanarRoundOff * slope);
      for (int i = 0; i < N && is_carried; ++i) {
        const Vector6 carried = space.carried.template segment<6>(6 * i);
        EXPECT_LE(largest(step.plane.projected(carried) - plane.carried[i].template head<3>()),
                  kPlanarRoundOff * slope);
      }
      EXPECT_NEAR(space.dissipated, plane.dissipated, kPlanarRoundOff * scale * slope);
      for (int k = 0; k < N - 1; ++k) {
        const double rates = std::max(1.0, largest(step.end_rates[k]));
        EXPECT_LE(largest(step.basis * step.result.points[k].strain - step.end_points[k].strain), kPlanarRoundOff * 10);
        EXPECT_LE(largest(step.basis * step.result.strain_rates[k] - step.end_rates[k]), kPlanarRoundOff * rates * 10);
      }
      for (int k = 0; k < N; ++k) {
        const Vector3& expected = step.end_motion[k].angular_acceleration;
        EXPECT_LE(largest(step.result.rotary[k] * step.normal() - expected), kPlanarRoundOff * slope);
      }
    }
}

TYPED_TEST(PlanarEndpoint, HasTheTangentOfItsResidual) {
  constexpr int N = TypeParam::value;
  RandomSource random(18);
  for (const EndpointOptions& options : kEndpointOptions) {
    if (options.internal_slope != 1) continue;  // of forces that are interpolated later
    expect_consistent_planar_tangent<N>(EndpointStep<N>(random, options),
                                        [](EndpointStep<N> at, bool with_tangent, std::array<Vector3, N>& forces) {
                                          return at.in_plane(with_tangent, forces);
                                        });
  }
}

// What carried strains become along an update is their first-order change.
TYPED_TEST(PlanarEndpoint, CarriesStrainsToFirstOrder) {
  constexpr int N = TypeParam::value;
  RandomSource random(19);
  EndpointStep<N> step(random, EndpointOptions{});
  std::array<Vector3T<double>, N> update;
  for (Vector3& u : update) u = random.vector();
  const auto strains = [&](double h) {
    EndpointStep<N> moved = step;
    for (int i = 0; i < N; ++i)
      for (int c = 0; c < 3; ++c) moved.move(i, c, h * update[i][c]);
    std::array<Vector3, N> forces;
    moved.in_plane(false, forces);
    Eigen::Matrix<double, 3, N - 1> all;
    for (int k = 0; k < N - 1; ++k) all.col(k) = moved.result.points[k].strain;
    return all;
  };
  std::array<Vector3, N> forces;
  step.in_plane(false, forces);
  planar::Element<N> constants;
  planar::set_lane(constants, 0, step.element, step.basis);
  std::array<Vector3T<double>, N - 1> carried;
  planar::carry_endpoint_strains<N, double>(constants, step.result.points, update, carried);
  const auto slope = difference(strains, difference_step);
  for (int k = 0; k < N - 1; ++k)
    EXPECT_LE(largest(carried[k] - step.result.points[k].strain - slope.col(k)), 10 * difference_tolerance);
}

}  // namespace
}  // namespace flexarm
