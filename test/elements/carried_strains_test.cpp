// Tests the strains that Newton's method carries from one iteration to the next (docs/notes/newton.md).
#include "elements/conserving_kernel.h"
#include "elements/kernel_checks.h"
#include "elements/tested_step.h"
#include "schemes/scheme.h"
#include "study_schemes/momentum_beam.h"
#include "study_schemes/newmark_beam.h"

namespace flexarm {
namespace {

using namespace test;

template <int Nodes>
using Row = Eigen::Matrix<double, 6 * Nodes, 1>;
template <int Nodes>
using Update = std::array<Vector6, Nodes>;

template <int Nodes>
Update<Nodes> random_update(RandomSource& random) {
  Update<Nodes> update;
  for (Vector6& node : update) node = random.vector6();
  return update;
}

/// The nodes moved by h times an update.
template <int Nodes>
ElementNodes<Nodes> moved(const RandomStep<Nodes>& step, const Update<Nodes>& update, double h) {
  ElementNodes<Nodes> out = step.nodes;
  for (int i = 0; i < Nodes; ++i) {
    out.end[i] += h * update[i].template head<3>();
    const Vector3 spin = h * update[i].template tail<3>();
    step.set_orientation(i, so3::exp_quaternion(spin) * step.nodes.orientation[i], out);
  }
  return out;
}

template <int Nodes>
double largest_entry(const CarriedStrains<Nodes>& strains) {
  double sum = 0;
  for (int k = 0; k < Nodes - 1; ++k) sum = std::max({sum, largest(strains.end[k]), largest(strains.conjugate[k])});
  return sum;
}

/// An element of the energy-momentum family.
template <int Nodes>
class Conserving {
 public:
  Conserving(const RandomStep<Nodes>& step, const TimeRule& rule) : step_(step), rule_(rule) {
    functions_ = functions_at<Nodes>(step.element, step.begin_orientation);
  }

  /// Strains of the nodes' configuration plus, to first order, their change by an update.
  CarriedStrains<Nodes> strains(const ElementNodes<Nodes>& nodes, const Update<Nodes>& update) const {
    KernelData<Nodes> data = data_at(nodes);
    std::array<Vector6T<Pack>, Nodes> moved;
    for (int i = 0; i < Nodes; ++i)
      for (int lane = 0; lane < Pack::kLanes; ++lane) set_lane(moved[i], lane, update[i]);
    packs::carry_strains<Nodes>(data.element, data.nodes, rule_, data.functions, data.begin.data(), moved,
                                data.end.data(), data.carried);
    CarriedStrains<Nodes> carried;
    for (int k = 0; k < Nodes - 1; ++k) {
      carried.end[k] = get_lane(data.carried.end[k], 0);
      carried.conjugate[k] = get_lane(data.carried.conjugate[k], 0);
    }
    carried.has_conjugate = data.carried.has_conjugate;
    return carried;
  }
  /// Residual and tangent. ElementSystem::carried is the difference to the residual in which the strains are
  /// independent variables.
  ElementSystem<Nodes> evaluate(const ElementNodes<Nodes>& nodes, const CarriedStrains<Nodes>* carried) const {
    KernelData<Nodes> data = data_at(nodes);
    if (carried) data.carry(*carried);
    data.evaluate(rule_, kStep, true);
    ElementSystem<Nodes> system;
    data.get(0, true, system);
    return system;
  }
  Row<Nodes> mixed(const ElementNodes<Nodes>& nodes, const CarriedStrains<Nodes>& strains) const {
    const ElementSystem<Nodes> system = evaluate(nodes, &strains);
    return system.residual + system.carried;
  }

 private:
  KernelData<Nodes> data_at(const ElementNodes<Nodes>& nodes) const {
    return KernelData<Nodes>({step_.element, nodes, functions_, step_.begin_points.data(), memory_.data()});
  }

  const RandomStep<Nodes>& step_;
  TimeRule rule_;
  ElementFunctions<Nodes> functions_;
  std::array<StrainMemory, Nodes - 1> memory_;
};

/// Returns strains + h change.
template <int Nodes>
CarriedStrains<Nodes> sum(const CarriedStrains<Nodes>& strains, const CarriedStrains<Nodes>& change, double h) {
  CarriedStrains<Nodes> out = strains;
  for (int k = 0; k < Nodes - 1; ++k) {
    out.end[k] += h * change.end[k];
    out.conjugate[k] += h * change.conjugate[k];
  }
  return out;
}

TimeRule rule_of(EnergyCorrection correction, int dissipation_order) {
  TimeRule rule;
  rule.correction = correction;
  if (dissipation_order > 0) rule.dissipation = numerical_dissipation(dissipation_order, 0.5, kStep);
  return rule;
}

const TimeRule kRules[] = {rule_of(EnergyCorrection::None, 0), rule_of(EnergyCorrection::Multiplier, 0),
                           rule_of(EnergyCorrection::Multiplier, 2)};

template <class Count>
class Carried : public ::testing::Test {};
TYPED_TEST_SUITE(Carried, NodeCounts);

TYPED_TEST(Carried, FollowAnUpdateToFirstOrder) {
  constexpr int N = TypeParam::value;
  RandomSource random(1);
  const RandomStep<N> step(random, 0.3);
  const Conserving<N> beam(step, kRules[0]);
  const Update<N> update = random_update<N>(random);
  Update<N> none;
  none.fill(Vector6::Zero());
  const CarriedStrains<N> at = beam.strains(step.nodes, none), after = beam.strains(step.nodes, update);
  const double scale = std::max(1.0, largest_entry(after));
  for (int k = 0; k < N - 1; ++k) {
    const auto strains_at = [&](double h) { return beam.strains(moved<N>(step, update, h), none); };
    const Vector6 end = difference([&](double h) { return Vector6(strains_at(h).end[k]); });
    const Vector6 conjugate = difference([&](double h) { return Vector6(strains_at(h).conjugate[k]); });
    EXPECT_LE(largest(after.end[k] - at.end[k] - end), difference_tolerance * scale);
    EXPECT_LE(largest(after.conjugate[k] - at.conjugate[k] - conjugate), difference_tolerance * scale);
  }
}

TYPED_TEST(Carried, FollowAnUpdateInTheOtherFamilies) {
  constexpr int N = TypeParam::value;
  for (const Interpolation interpolation : {Interpolation::Local, Interpolation::Incremental}) {
    RandomSource random(2);
    RandomStep<N> step(random, 0.3);
    step.set_interpolation(random, interpolation);
    const Update<N> update = random_update<N>(random);
    Update<N> none;
    none.fill(Vector6::Zero());
    using Strains = Eigen::Matrix<double, 6, N - 1>;
    const auto strains = [&](const ElementNodes<N>& nodes, const Update<N>& by) {
      std::array<Vector6, N - 1> out;
      carry_strains<N>(step.element, nodes, by, out.data());
      return Strains(Eigen::Map<const Strains>(out[0].data()));
    };
    const Strains change = strains(step.nodes, update) - strains(step.nodes, none);
    const Strains expected = difference([&](double h) { return strains(moved<N>(step, update, h), none); });
    EXPECT_LE(largest(change - expected), difference_tolerance * std::max(1.0, largest(change)));
  }
}

// Carried strains that equal the strains of the configuration change neither residual nor tangent.
TYPED_TEST(Carried, OfTheConfigurationItselfLeaveTheSystem) {
  constexpr int N = TypeParam::value;
  RandomSource random(3);
  const RandomStep<N> step(random, 0.3);
  Update<N> none;
  none.fill(Vector6::Zero());
  for (const TimeRule& rule : kRules) {
    const Conserving<N> beam(step, rule);
    const CarriedStrains<N> own = beam.strains(step.nodes, none);
    const ElementSystem<N> plain = beam.evaluate(step.nodes, nullptr), carried = beam.evaluate(step.nodes, &own);
    EXPECT_LE(largest(carried.residual - plain.residual), 1e-13 * largest(plain.residual));
    EXPECT_LE(largest(carried.tangent - plain.tangent), 1e-13 * largest(plain.tangent));
  }
}

// With the strains e as independent variables, the equations are M(u, e) = 0 and e = strains(u). Eliminating e gives
// the residual M + M_e (strains(u) - e) and the tangent M_u + M_e strains'(u). Both are compared with differences of M.
TYPED_TEST(Carried, GiveNewtonsMethodForTheStrainsAsWell) {
  constexpr int N = TypeParam::value;
  constexpr double kSize = 0.3;
  RandomSource random(4);
  const RandomStep<N> step(random, kSize);
  Update<N> none;
  none.fill(Vector6::Zero());
  for (const TimeRule& rule : kRules) {
    const Conserving<N> beam(step, rule);
    const CarriedStrains<N> own = beam.strains(step.nodes, none);
    CarriedStrains<N> away;
    for (int k = 0; k < N - 1; ++k) away.end[k] = 0.1 * random.vector6(), away.conjugate[k] = 0.1 * random.vector6();
    CarriedStrains<N> carried = sum<N>(own, away, 1);
    carried.has_conjugate = true;
    const ElementSystem<N> system = beam.evaluate(step.nodes, &carried);
    const double scale = std::max(largest(system.tangent), largest(system.residual));

    const Row<N> back = difference([&](double h) { return beam.mixed(step.nodes, sum<N>(carried, away, -h)); },
                                   kSize * difference_step);
    EXPECT_LE(largest(system.residual - beam.mixed(step.nodes, carried) - back), difference_tolerance / kSize * scale);

    const Update<N> update = random_update<N>(random);
    const CarriedStrains<N> change = sum<N>(beam.strains(step.nodes, update), own, -1);
    Row<N> direction;
    for (int i = 0; i < N; ++i) direction.template segment<6>(6 * i) = update[i];
    const Row<N> slope =
        difference([&](double h) { return beam.mixed(moved<N>(step, update, h), sum<N>(carried, change, h)); },
                   kSize * difference_step);
    EXPECT_LE(largest(system.tangent * direction - slope), 6 * N * difference_tolerance / kSize * scale);
  }
}

/// The same for families whose stress depends only on the strains at the end.
template <int Nodes, class Evaluate>
void expect_newtons_method(const RandomStep<Nodes>& step, RandomSource& random, const Evaluate& evaluate) {
  using Strains = std::array<Vector6, Nodes - 1>;
  constexpr double kSize = 0.3;
  const auto strains = [&](const Update<Nodes>& update) {
    Strains out;
    carry_strains<Nodes>(step.element, step.nodes, update, out.data());
    return out;
  };
  const auto mixed = [&](const ElementNodes<Nodes>& nodes, const Strains& carried) -> Row<Nodes> {
    const ElementSystem<Nodes> system = evaluate(nodes, carried);
    return system.residual + system.carried;
  };
  const Update<Nodes> update = random_update<Nodes>(random);
  Update<Nodes> none;
  none.fill(Vector6::Zero());
  const Strains own = strains(none), after = strains(update);
  Strains carried = own;
  for (Vector6& strain : carried) strain += 0.1 * random.vector6();
  const ElementSystem<Nodes> system = evaluate(step.nodes, carried);
  EXPECT_EQ(system.residual, evaluate(step.nodes, own).residual);
  Row<Nodes> direction;
  for (int i = 0; i < Nodes; ++i) direction.template segment<6>(6 * i) = update[i];
  const Row<Nodes> slope = difference(
      [&](double h) {
        Strains moving = carried;
        for (int k = 0; k < Nodes - 1; ++k) moving[k] += h * (after[k] - own[k]);
        return mixed(moved<Nodes>(step, update, h), moving);
      },
      kSize * difference_step);
  const double scale = std::max(largest(system.tangent), largest(system.residual));
  EXPECT_LE(largest(system.tangent * direction - slope), 6 * Nodes * difference_tolerance / kSize * scale);
}

TYPED_TEST(Carried, GiveNewtonsMethodAtTheEndOfTheStep) {
  constexpr int N = TypeParam::value;
  RandomSource random(5);
  RandomStep<N> step(random, 0.3);
  const NewmarkRule rule{0.25, 0.5, kStep, 0};
  const std::array<Vector6, N - 1> rates{};
  for (const double damping : {0.0, 0.2}) {
    step.element.stiffness_damping = damping;
    expect_newtons_method<N>(step, random,
                             [&](const ElementNodes<N>& nodes, const std::array<Vector6, N - 1>& carried) {
                               std::array<PointKinematics, N - 1> end;
                               std::array<Vector6, N - 1> new_rates;
                               ElementSystem<N> system;
                               system.set_zero();
                               endpoint_internal<N>(step.element, nodes, &rule, step.begin_points.data(), rates.data(),
                                                    true, end.data(), new_rates.data(), system, carried.data());
                               return system;
                             });
  }
}

TYPED_TEST(Carried, GiveNewtonsMethodInTheMomentumFamily) {
  constexpr int N = TypeParam::value;
  RandomSource random(6);
  RandomStep<N> step(random, 0.3);
  const RotaryTerm<N> no_rotary = [](bool, ElementEnergy<N>*, ElementSystem<N>&) {};
  for (const char* name : {"m1", "std"})
    for (const double damping : {0.0, 0.2}) {
      step.element.stiffness_damping = damping;
      expect_newtons_method<N>(step, random,
                               [&](const ElementNodes<N>& nodes, const std::array<Vector6, N - 1>& carried) {
                                 std::array<PointKinematics, N - 1> end;
                                 ElementSystem<N> system;
                                 momentum_beam<N>(step.element, nodes, *find_scheme(name), step.begin_points.data(),
                                                  kStep, no_rotary, true, end.data(), system, carried.data());
                                 return system;
                               });
    }
}

}  // namespace
}  // namespace flexarm
