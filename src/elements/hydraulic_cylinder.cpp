#include "elements/hydraulic_cylinder.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include <fmt/format.h>

namespace flexarm {
namespace {

std::vector<int> moving_nodes(const CylinderPlan& plan) {
  std::vector<int> nodes;
  for (const int node : {plan.rod.node, plan.barrel.node, plan.pump.node})
    if (node >= 0) nodes.push_back(node);
  return nodes;
}

const Vector3& position(const std::vector<NodePose>& nodes, int node) {
  return nodes[node].position;
}

const Vector3& position(const State& state, int node) {
  return state.nodes[node].position;
}

}  // namespace

/// Volumes and contents of both chambers at an instant.
struct HydraulicCylinder::Contents {
  double length = 0;
  std::array<double, 2> volume, oil;
};

/// Sums over both chambers.
struct HydraulicCylinder::Sums {
  double tension = 0, by_length = 0, by_pump = 0;               ///< energy per change of the length
  double effort = 0, effort_by_length = 0, effort_by_pump = 0;  ///< energy per change of the pump's coordinate
  double dissipated = 0, work = 0;                              ///< [J]
  bool is_possible = true;                                      ///< whether oil is left in both chambers
};

HydraulicCylinder::HydraulicCylinder(std::string name, const CylinderPlan& plan, std::vector<int> functions)
    : ForceElement(std::move(name), moving_nodes(plan), std::move(functions)), plan_(plan) {
  assert(plan.rod.node != plan.barrel.node);
  const auto local = [&](int node) {
    return node < 0 ? -1 : static_cast<int>(std::find(reach().begin(), reach().end(), node) - reach().begin());
  };
  local_ = {local(plan.rod.node), local(plan.barrel.node), local(plan.pump.node)};
}

std::string HydraulicCylinder::description() const {
  double stiffness = 0;
  for (const CylinderPlan::Chamber& chamber : plan_.chambers) {
    const double volume = chamber.volume + chamber.area * plan_.start_length;
    if (chamber.start_pressure > 0)
      stiffness += chamber.oil.bulk_modulus * chamber.area * chamber.area /
                   chamber.oil.content_at(volume, chamber.start_pressure);
  }
  return fmt::format("oil: {:.6g} and {:.6g} Pa, {:.6g} N/m at the start", plan_.chambers[0].start_pressure,
                     plan_.chambers[1].start_pressure, stiffness);
}

template <class Nodes>
double HydraulicCylinder::pumped(const Nodes& nodes) const {
  return (plan_.pump.node < 0 ? plan_.pump.still : position(nodes, plan_.pump.node).x()) - plan_.pump.zero;
}

HydraulicCylinder::Contents HydraulicCylinder::contents(const State& state, const double* memory) const {
  Contents out;
  out.length = LineEnds(plan_.rod, plan_.barrel, state).length();
  const double pumped = this->pumped(state);
  for (int i = 0; i < 2; ++i) {
    const CylinderPlan::Chamber& chamber = plan_.chambers[i];
    out.volume[i] = chamber.volume + chamber.area * out.length;
    out.oil[i] = memory[i] + chamber.area * pumped;
  }
  return out;
}

bool HydraulicCylinder::suits_backward_steps() const {
  return std::none_of(plan_.chambers.begin(), plan_.chambers.end(), [](const CylinderPlan::Chamber& chamber) {
    return chamber.oil.makes_up || chamber.oil.relief_pressure < chamber.oil.bulk_modulus;
  });
}

void HydraulicCylinder::start(const State& state, const double*, double* memory) const {
  const double none[2] = {0, 0};
  const Contents here = contents(state, none);
  for (int i = 0; i < 2; ++i)
    memory[i] = plan_.chambers[i].oil.content_at(here.volume[i], plan_.chambers[i].start_pressure) - here.oil[i];
}

void HydraulicCylinder::carry(const ForceElement& before, const double* old_memory, const State&,
                              double* memory) const {
  if (dynamic_cast<const HydraulicCylinder*>(&before)) std::copy_n(old_memory, memory_size(), memory);
}

double HydraulicCylinder::energy(const State& state, const double* memory) const {
  const Contents here = contents(state, memory);
  double out = 0;
  for (int i = 0; i < 2; ++i) out += plan_.chambers[i].oil.energy(here.volume[i], here.oil[i]);
  return out;
}

HydraulicCylinder::Sums HydraulicCylinder::sums(const ForceStep& step, double begin_length, double end_length) const {
  Sums out;
  const double flow = functions().empty() ? 0 : step.functions[0].mean * step.duration / plan_.chambers[0].area;
  const double begin = pumped(step.begin), end = pumped(step.end);
  for (int i = 0; i < 2; ++i) {
    const auto& [chamber, area, volume, pressure] = plan_.chambers[i];
    // Without valves exactly what the next step begins with, so that round-off does not add up.
    const double memory = step.memory[i] + area * flow;
    const OilStep oil = chamber.over(volume + area * begin_length, step.memory[i] + area * begin,
                                     volume + area * end_length, memory + area * end, step.at_end);
    out.tension -= area * oil.pressure;
    out.by_length -= area * area * oil.by_volume;
    out.by_pump -= area * area * oil.by_oil;
    out.effort += area * oil.price;
    out.effort_by_length += area * area * oil.price_by_volume;
    out.effort_by_pump += area * area * oil.price_by_oil;
    out.dissipated += oil.dissipated;
    out.work += oil.price * area * flow;
    out.is_possible = out.is_possible && oil.content > 0;
    step.new_memory[i] = memory + oil.through_valves;
  }
  return out;
}

void HydraulicCylinder::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  action.residual.setZero();
  const LineEnds begin(plan_.rod, plan_.barrel, step.begin), end(plan_.rod, plan_.barrel, step.end);
  const Sums oil = sums(step, begin.length(), end.length());
  // Without oil the step fails, also if no node can move.
  action.dissipated = oil.is_possible ? oil.dissipated : std::numeric_limits<double>::quiet_NaN();
  action.work = oil.work;
  const auto [rod, barrel, pump] = local_;
  const LineStep line(begin, end, step.at_end);
  const bool with_tangent = action.tangent.size() != 0;
  Vector12 residual;
  Matrix12 tangent;
  line.act(oil.is_possible ? oil.tension : std::numeric_limits<double>::quiet_NaN(), oil.by_length, residual,
           with_tangent ? &tangent : nullptr);
  const int nodes[2] = {rod, barrel};
  for (int i = 0; i < 2; ++i)
    if (nodes[i] >= 0) action.residual.segment<6>(6 * nodes[i]) = residual.segment<6>(6 * i);
  if (pump >= 0) action.residual[6 * pump] = oil.effort;
  if (!with_tangent) return;
  action.tangent.setZero();
  const Vector12 direction = line.direction(), gradient = end.gradient();
  for (int i = 0; i < 2; ++i) {
    if (nodes[i] < 0) continue;
    for (int j = 0; j < 2; ++j)
      if (nodes[j] >= 0) action.tangent.block<6, 6>(6 * nodes[i], 6 * nodes[j]) = tangent.block<6, 6>(6 * i, 6 * j);
    if (pump < 0) continue;
    action.tangent.block<6, 1>(6 * nodes[i], 6 * pump) = oil.by_pump * direction.segment<6>(6 * i);
    action.tangent.block<1, 6>(6 * pump, 6 * nodes[i]) = oil.effort_by_length * gradient.segment<6>(6 * i).transpose();
  }
  if (pump >= 0) action.tangent(6 * pump, 6 * pump) = oil.effort_by_pump;
}

// ---------------------------------------------------------------- small motions and output

ForceMeasures HydraulicCylinder::measures(const State& state, const double* memory, const int*) const {
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(reach().size());
  ForceMeasures out{Eigen::MatrixXd::Zero(2, size), Eigen::MatrixXd::Zero(2, 2)};
  const Contents here = contents(state, memory);
  const Vector12 gradient = LineEnds(plan_.rod, plan_.barrel, state).gradient();
  for (int i = 0; i < 2; ++i) {
    const auto& [oil, area, volume, pressure] = plan_.chambers[i];
    for (int k = 0; k < 2; ++k)
      if (local_[k] >= 0) out.rows.block<1, 6>(i, 6 * local_[k]) = area * gradient.segment<6>(6 * k).transpose();
    if (!oil.is_full(here.volume[i], here.oil[i])) continue;
    // The energy is of first degree in volume and content, so its second derivative has rank one.
    if (local_[2] >= 0) out.rows(i, 6 * local_[2]) = -area * here.volume[i] / here.oil[i];
    out.stiffness(i, i) = oil.bulk_modulus / here.oil[i];
  }
  return out;
}

DamperTensions HydraulicCylinder::dampers(const State&, const double*, const Eigen::VectorXd&) const {
  return {Eigen::VectorXd::Zero(2), Eigen::MatrixXd::Zero(2, 2)};
}

std::vector<ForceOutput> HydraulicCylinder::outputs() const {
  return {{"pressure_1", "Pa"}, {"pressure_2", "Pa"}};
}

void HydraulicCylinder::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  const Contents here = contents(motion.state, motion.memory);
  for (int i = 0; i < 2; ++i) values.push_back(plan_.chambers[i].oil.pressure(here.volume[i], here.oil[i]));
}

}  // namespace flexarm
