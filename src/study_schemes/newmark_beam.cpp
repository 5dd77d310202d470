#include "study_schemes/newmark_beam.h"

#include <cassert>

#include "elements/orders.h"
#include "study_schemes/additive_beam.h"

namespace flexarm {

template <int Nodes>
void newmark_translation(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                         bool with_tangent, ElementSystem<Nodes>& system) {
  std::array<Vector3, Nodes> acceleration;
  for (int i = 0; i < Nodes; ++i)
    acceleration[i] = rule.acceleration(nodes.end[i] - nodes.begin[i], nodes.velocity[i], nodes.acceleration[i]);
  add_translational<Nodes>(element.mass, acceleration, rule.acceleration_slope(), with_tangent, system);
}

template <int Nodes>
void newmark_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                          bool with_tangent, ElementSystem<Nodes>& system) {
  if (element.mass_damping == 0) return;
  std::array<Vector3, Nodes> force;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 a = rule.acceleration(nodes.end[i] - nodes.begin[i], nodes.velocity[i], nodes.acceleration[i]);
    const Vector3 v = rule.velocity(nodes.velocity[i], nodes.acceleration[i], a);
    force[i] = element.mass_damping * ((1 + rule.alpha) * v - rule.alpha * nodes.velocity[i]);
    for (int j = 0; j < Nodes; ++j)
      system.dissipated += element.mass(i, j) * force[i].dot(nodes.end[j] - nodes.begin[j]);
  }
  add_translational<Nodes>(element.mass, force, element.mass_damping * (1 + rule.alpha) * rule.velocity_slope(),
                           with_tangent, system);
}

namespace {

/// The elastic stress at the end of a step and, with a rule, that of stiffness-proportional damping by the strain rate
/// at t_{n+1+alpha}. Counts what the damping dissipates, and writes the strain rates at the end.
template <int Nodes>
class DampedLaw {
 public:
  DampedLaw(const BeamElement<Nodes>& element, const NewmarkRule* rule, const PointKinematics* begin,
            const Vector6* strain_rates, Vector6* new_strain_rates, double& dissipated)
      : element_(element),
        rule_(rule),
        begin_(begin),
        strain_rates_(strain_rates),
        new_strain_rates_(new_strain_rates),
        dissipated_(dissipated),
        is_even_(is_damped_evenly(element)) {}

  Vector6 stress(int k, const Vector6& strain) {
    const Matrix6& elastic = element_.stiffness_points[k].stiffness;
    if (!is_even_) damped_ = damped_stiffness(element_, k), sum_ = elastic;
    slope_ = 1;
    new_strain_rates_[k].setZero();
    Vector6 stress = elastic * strain;
    if (!is_damped()) return stress;
    const double eta = element_.stiffness_damping;
    const Rates rates = rates_at(k, strain);
    const Vector6 damping = eta * (damped(k) * rates.acting);
    stress += damping;
    new_strain_rates_[k] = rates.end;
    dissipated_ += element_.stiffness_points[k].weight * damping.dot(rates.increment);
    slope_ += eta / (rule_->gamma * rule_->step);
    if (!is_even_) sum_ = elastic + (slope_ - 1) * damped_;
    return stress;
  }
  Vector6 seen_stress(int k, const Vector6& strain) const {
    Vector6 stress = element_.stiffness_points[k].stiffness * strain;
    if (is_damped()) stress += element_.stiffness_damping * (damped(k) * rates_at(k, strain).acting);
    return stress;
  }
  const Matrix6& stiffness(int k) const { return is_even_ ? element_.stiffness_points[k].stiffness : sum_; }
  double slope() const { return is_even_ ? slope_ : 1; }

 private:
  struct Rates {
    Vector6 increment, end, acting;  // of the strain over the step; rates at its end and at t_{n+1+alpha}
  };
  bool is_damped() const { return rule_ && element_.stiffness_damping != 0; }
  const Matrix6& damped(int k) const { return is_even_ ? element_.stiffness_points[k].stiffness : damped_; }
  Rates rates_at(int k, const Vector6& strain) const {
    Rates out;
    out.increment = (strain - begin_[k].strain) / (1 + rule_->alpha);
    out.end = (out.increment / rule_->step - (1 - rule_->gamma) * strain_rates_[k]) / rule_->gamma;
    out.acting = (1 + rule_->alpha) * out.end - rule_->alpha * strain_rates_[k];
    return out;
  }

  const BeamElement<Nodes>& element_;
  const NewmarkRule* rule_;
  const PointKinematics* begin_;
  const Vector6* strain_rates_;
  Vector6* new_strain_rates_;
  double& dissipated_;
  bool is_even_;
  double slope_ = 1;      // d(stress)/d(strain) of the last point is C + (slope_ - 1) D C D
  Matrix6 damped_, sum_;  // D C D and this sum, unless D is the identity
};

}  // namespace

template <int Nodes, class Form>
void endpoint_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system,
                       const Vector6* carried) {
  assert(end && new_strain_rates);
  assert(!rule || (begin && strain_rates && rule->step != 0));
  DampedLaw<Nodes> law(element, rule, begin, strain_rates, new_strain_rates, system.dissipated);
  const ElementRotations<Nodes> rotations(nodes, Form::needs_variation(with_tangent));
  add_internal_forces<Nodes, Form>(element, nodes, stiffness_rotations(element, nodes, rotations), law, with_tangent,
                                   end, system, carried);
}

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes)                                                                            \
  template decltype(newmark_translation<Nodes>) newmark_translation<Nodes>;                           \
  template decltype(newmark_mass_damping<Nodes>) newmark_mass_damping<Nodes>;                         \
  template decltype(endpoint_internal<Nodes, SpinForm>) endpoint_internal<Nodes, SpinForm>;           \
  template decltype(endpoint_internal<Nodes, VariationForm>) endpoint_internal<Nodes, VariationForm>; \
  template decltype(endpoint_internal<Nodes, AdditiveForm>) endpoint_internal<Nodes, AdditiveForm>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
