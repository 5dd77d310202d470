// Tests that the planar kernel of the energy-momentum family equals the three-dimensional kernel for motion in a plane.
#include "elements/planar_beam.h"
#include "elements/conserving_kernel.h"
#include "elements/random_planar_step.h"
#include "elements/tested_step.h"

namespace flexarm {
namespace {

using namespace test;

struct PlanarOptions {
  bool is_corrected, is_damped;
  MidFunctions mid = MidFunctions::Explicit;
  int dissipation_order = 0;
  double size = 0.5;  // size of the step's increments

  TimeRule rule() const { return time_rule(is_corrected, mid, dissipation_order); }
};

const PlanarOptions kPlanarOptions[] = {{true, false},
                                        {true, true},
                                        {false, true},
                                        {true, false, MidFunctions::Explicit, 0, 1e-3},
                                        {true, false, MidFunctions::Symmetric},
                                        {true, true, MidFunctions::Explicit, 2}};

template <int Nodes>
struct PlanarStep : RandomPlanarStep<Nodes> {
  using Base = RandomPlanarStep<Nodes>;
  using Base::begin, Base::end, Base::velocity, Base::begin_angle, Base::end_angle, Base::plane, Base::basis,
      Base::element, Base::height, Base::turned;

  PlanarStep(RandomSource& random, const PlanarOptions& options)
      : Base(random, options.size), options(options), rule(options.rule()) {
    if (options.is_damped) element.stiffness_damping = element.mass_damping = 0.2;
    for (double& turn : foreseen) turn = options.mid == MidFunctions::Explicit ? options.size * random.number() : 0.0;
    for (StrainMemory& m : memory) {
      m.average = basis * random.vector();
      m.rate = basis * random.vector();
      m.delayed_rate = basis * random.vector();
    }
  }

  double increment(int i) const { return 2 * std::tan(0.5 * (end_angle[i] - begin_angle[i])); }

  /// Forces {f_1, f_2, phi} and blocks of the nodes by the three-dimensional kernel.
  ElementSystem<Nodes> in_three_dimensions(bool with_tangent) {
    std::array<Quaternion, Nodes> begin_orientation;
    std::array<Vector3, Nodes> turns;
    ElementNodes<Nodes> nodes;
    for (int i = 0; i < Nodes; ++i) {
      nodes.begin[i] = this->in_space(begin[i], height);
      nodes.end[i] = this->in_space(end[i], height);
      nodes.orientation[i] = turned(end_angle[i]);
      nodes.increment[i] = increment(i) * plane.normal;
      nodes.velocity[i] = this->in_space(velocity[i]);
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
    KernelData<Nodes> data({element, nodes, functions, points.data(), memory.data()});
    if (is_carried) {
      flexarm::CarriedStrains<Nodes> carried;
      for (int k = 0; k < Nodes - 1; ++k)
        carried.end[k] = basis * carried_end, carried.conjugate[k] = basis * carried_s;
      carried.has_conjugate = true;
      data.carry(carried);
    }
    data.evaluate(rule, kStep, with_tangent);
    ElementSystem<Nodes> out;
    data.get(0, with_tangent, out);
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
      const PlanarPose first = plane.pose(i, this->in_space(begin[i], height), turned(begin_angle[i])),
                       last = plane.pose(i, this->in_space(end[i], height), turned(end_angle[i]));
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

  PlanarOptions options;
  TimeRule rule;
  std::array<double, Nodes> foreseen;
  std::array<StrainMemory, Nodes - 1> memory, end_memory;
  std::array<flexarm::PointKinematics, Nodes - 1> end_points;
  std::array<planar::StrainMemory<double>, Nodes - 1> planar_memory;
  std::array<planar::PointKinematics<double>, Nodes - 1> planar_points;
  bool is_carried = false;
  Vector3 carried_end = {0.1, -0.2, 0.3}, carried_s = {0.2, 0.05, -0.1};
};

template <int Nodes>
std::array<Vector3, Nodes> forces_of(const planar::BlockSystem<Nodes>& system) {
  std::array<Vector3, Nodes> forces;
  for (int i = 0; i < Nodes; ++i) forces[i] = system.residual[i].template head<3>();
  return forces;
}

template <class Count>
class PlanarBeam : public ::testing::Test {};
TYPED_TEST_SUITE(PlanarBeam, NodeCounts);

TYPED_TEST(PlanarBeam, IsTheKernelOfThreeDimensionsSeenInThePlane) {
  constexpr int N = TypeParam::value;
  RandomSource random(7);
  for (const PlanarOptions& options : kPlanarOptions)
    for (const bool is_carried : {false, true}) {
      PlanarStep<N> step(random, options);
      step.is_carried = is_carried;
      const ElementSystem<N> space = step.in_three_dimensions(true);
      const planar::BlockSystem<N> plane = step.in_plane(true);
      // The energy multiplier divides the round-off of the work by relative rotations, its derivative by their squares.
      const double turn = options.is_corrected ? 0.5 * options.size : 1.0;
      const double scale = std::max(largest(space.residual), 1.0) / turn,
                   slope = largest(space.tangent) / (turn * turn);
      expect_same_in_plane<N>(step.plane, space, forces_of(plane), plane, kPlanarRoundOff * scale,
                              kPlanarRoundOff * slope);
      for (int i = 0; i < N && is_carried; ++i) {
        const Vector6 carried = space.carried.template segment<6>(6 * i);
        EXPECT_LE(largest(step.plane.projected(carried) - plane.carried[i].template head<3>()),
                  kPlanarRoundOff * slope);
      }
      EXPECT_NEAR(space.dissipated, plane.dissipated, kPlanarRoundOff * std::max(1.0, std::abs(space.dissipated)));
      for (int k = 0; k < N - 1; ++k) {
        const Vector6 strain = step.basis * step.planar_points[k].strain;
        EXPECT_LE(largest(strain - step.end_points[k].strain), kPlanarRoundOff * 10);
        if (options.dissipation_order > 0) {
          EXPECT_LE(largest(step.basis * step.planar_memory[k].average - step.end_memory[k].average),
                    kPlanarRoundOff * 10);
          EXPECT_LE(largest(step.basis * step.planar_memory[k].rate - step.end_memory[k].rate), kPlanarRoundOff * 100);
        }
      }
    }
}

TYPED_TEST(PlanarBeam, HasTheTangentOfItsResidual) {
  constexpr int N = TypeParam::value;
  RandomSource random(8);
  for (const PlanarOptions& options : kPlanarOptions) {
    const PlanarStep<N> step(random, options);
    expect_consistent_planar_tangent<N>(step, [](PlanarStep<N> at, bool with_tangent, std::array<Vector3, N>& forces) {
      const planar::BlockSystem<N> system = at.in_plane(with_tangent);
      forces = forces_of(system);
      return system;
    });
  }
}

}  // namespace
}  // namespace flexarm
