#include "flexarm/simulation/simulation.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/modes.h"
#include "analysis/statics.h"
#include "integrators/explicit_limit.h"
#include "model/carried_origin.h"
#include "simulation/entry.h"
#include "simulation/failure_text.h"
#include "simulation/implementation.h"
#include "simulation/observables.h"
#include "simulation/servo_commands.h"
#include "simulation/touching.h"
#include "simulation/wrenches.h"

namespace flexarm {
namespace {

void require_points_between(int between) {
  if (between < 0)
    throw std::invalid_argument(fmt::format("between: expected a number of points >= 0, got {}", between));
}

}  // namespace

Simulation::Simulation(scene::SceneDescription scene, const SimulationOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(scene), options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation::Simulation(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Simulation Simulation::copy() const {
  return Simulation(std::make_unique<Implementation>(*implementation_));
}

const scene::SceneDescription& Simulation::scene() const {
  return implementation_->scene;
}

const scene::Diagnostics& Simulation::start_warnings() const {
  return implementation_->start_warnings;
}

StepResult Simulation::step() {
  StepResult result = implementation_->advance();
  carry_origin(implementation_->model, implementation_->state);
  implementation_->forget_published();
  implementation_->static_norms.clear();
  implementation_->take_samples(false);
  return result;
}

std::string Simulation::explain(const StepResult& result) const {
  const Implementation& own = *implementation_;
  const bool is_explicit_step = own.scheme.tableau && !result.converged && result.failure.step > 0;
  return failure_text(
      own.model, own.settings, result,
      is_explicit_step ? explicit_limit(own.model, own.scheme, *own.initial, own.settings.step) : ExplicitLimit());
}

void Simulation::reset() {
  implementation_->set_state(*implementation_->initial);
}

Snapshot Simulation::snapshot() const {
  Snapshot taken;
  snapshot(taken);
  return taken;
}

void Simulation::snapshot(Snapshot& snapshot) const {
  if (snapshot.state_.use_count() == 1)
    *snapshot.state_ = implementation_->state;
  else
    snapshot.state_ = std::make_shared<State>(implementation_->state);
  snapshot.state_->wrenches.reserve(kRoomForWrenches);
  snapshot.initial_ = implementation_->initial;
}

void Simulation::restore(const Snapshot& snapshot) {
  if (!snapshot.state_) throw std::invalid_argument("nothing was taken into the snapshot");
  if (snapshot.initial_ == implementation_->initial)
    implementation_->set_state(*snapshot.state_);
  else
    implementation_->restore(*snapshot.state_);
}

double Simulation::time() const {
  return implementation_->state.time;
}
double Simulation::step_size() const {
  return implementation_->settings.step;
}
void Simulation::set_step_size(double step) {
  if (!(step > 0 && step <= kLongestStep))
    throw std::invalid_argument(fmt::format("a step of {:g} s: expected > 0 and at most {:g} s", step, kLongestStep));
  require_hit_samples(implementation_->model, step);
  implementation_->set_step(step, {});
  implementation_->scene.integrator.step = step;
}

double Simulation::tolerance() const {
  return implementation_->settings.tolerance;
}

void Simulation::set_tolerance(double tolerance) {
  if (!(tolerance > 0 && tolerance <= kLargestTolerance))
    throw std::invalid_argument(
        fmt::format("a tolerance of {:g}: expected > 0 and at most {:g}", tolerance, kLargestTolerance));
  implementation_->settings.tolerance = tolerance;
  implementation_->scene.integrator.tolerance = tolerance;
  implementation_->stepper->set_tolerance(tolerance);
}

std::string Simulation::scheme() const {
  return std::string(implementation_->scheme.name);
}

void Simulation::apply_wrenches(const std::vector<AppliedWrench>& wrenches) {
  std::vector<NodalLoad>& loads = implementation_->placed_wrenches;
  loads.clear();
  for (const AppliedWrench& wrench : wrenches) loads.push_back(placed_wrench(implementation_->model, wrench));
  require_no_pulls(implementation_->scheme, loads);
  implementation_->state.wrenches.assign(loads.begin(), loads.end());
}

void Simulation::take_over(const Simulation& other) {
  Implementation& s = *implementation_;
  const Implementation& from = *other.implementation_;
  if (s.coordinate_names != from.coordinate_names || s.link_names != from.link_names)
    throw std::invalid_argument("other joints or links");
  require_no_pulls(s.scheme, from.state.wrenches);
  const State before = s.state;
  try {
    s.restore(s.state_of_other(from));
  } catch (const std::invalid_argument&) {
    s.set_state(before);
    throw;
  }
  s.state.work += s.published_energies().total() - from.published_energies().total();
  s.forget_published();
}

// ---------------------------------------------------------------- frames

const std::vector<std::string>& Simulation::link_names() const {
  return implementation_->link_names;
}

Pose Simulation::link_pose(std::size_t link) const {
  return implementation_->in_world(entry(implementation_->model.links, link, "link").frame);
}

bool Simulation::is_flexible(std::size_t link) const {
  return entry(implementation_->model.links, link, "link").beam.has_value();
}

Pose Simulation::tip_pose(std::size_t link) const {
  return implementation_->in_world(implementation_->tip(link));
}

void Simulation::beam_points(std::size_t link, int between, std::vector<BeamPoint>& points) const {
  const LinkFrame& frame = entry(implementation_->model.links, link, "link");
  require_points_between(between);
  if (const auto& line = implementation_->rigid_lines[link]) rigid_points(*line, link_pose(link), points);
  if (!frame.beam) return;
  const std::size_t first = points.size();
  flexarm::beam_points(implementation_->model, implementation_->state, *frame.beam, between, points);
  for (std::size_t i = first; i < points.size(); ++i) points[i].pose = implementation_->in_world(points[i].pose);
}

std::vector<Pose> Simulation::undeformed_sections(std::size_t link, int between) const {
  const Model& model = implementation_->built ? *implementation_->built : implementation_->model;
  const LinkFrame& frame = entry(model.links, link, "link");
  require_points_between(between);
  if (const auto& line = implementation_->rigid_lines[link]) return line->sections;
  return frame.beam ? flexarm::undeformed_sections(model, frame, between) : std::vector<Pose>();
}

bool Simulation::is_fixed_to_world(std::size_t link) const {
  return entry(implementation_->model.links, link, "link").frame.node < 0;
}

double Simulation::beam_radius(std::size_t link) const {
  const LinkFrame& frame = entry(implementation_->model.links, link, "link");
  if (const auto& line = implementation_->rigid_lines[link]) return line->radius;
  return frame.beam ? frame.beam->radius : 0.0;
}

// ---------------------------------------------------------------- observables and analyses

Energies Simulation::energies() const {
  return implementation_->published_energies();
}
Vector3 Simulation::momentum() const {
  return implementation_->published_momenta().linear;
}
Vector3 Simulation::angular_momentum() const {
  const Momenta& momenta = implementation_->published_momenta();
  return world_origin(implementation_->model, implementation_->state).cross(momenta.linear) + momenta.angular;
}
ProbeState Simulation::probe(std::size_t index) const {
  const Implementation& s = *implementation_;
  const MotionView view = s.view();
  const ProbePoint& point = entry(view.model.probes, index, "probe");
  ProbeState probe = probe_state(view.model, view.state, s.published.velocities(view).nodes(), point);
  probe.pose.position += probe_origin(view.model, view.state, point);
  return probe;
}
Pose Simulation::probe_pose(std::size_t index) const {
  return pose_in_world(implementation_->model, implementation_->state,
                       entry(implementation_->model.probes, index, "probe"));
}
ProbeAcceleration Simulation::probe_acceleration(std::size_t index) const {
  const MotionView view = implementation_->view();
  return implementation_->published.past(view).acceleration(view, entry(view.model.probes, index, "probe"));
}
BeamPoint Simulation::section(std::size_t link, double arc_length) const {
  const LinkFrame& frame = entry(implementation_->model.links, link, "link");
  if (!frame.beam) throw std::invalid_argument("link '" + frame.name + "' has no sections: it is rigid");
  if (!(arc_length >= 0 && arc_length <= frame.beam->length))
    throw std::invalid_argument(
        fmt::format("link '{}' has sections from 0 to {} m, not at {} m", frame.name, frame.beam->length, arc_length));
  const ElementPlace place = element_at(*frame.beam, arc_length);
  BeamPoint point = section_point(implementation_->model, implementation_->state, *frame.beam, place.element, place.xi);
  point.pose = implementation_->in_world(point.pose);
  return point;
}
Wrench Simulation::reaction(std::size_t link) const {
  const Model& model = implementation_->model;
  const std::string& name = entry(model.links, link, "link").name;
  const std::vector<scene::Sensor>& sensors = implementation_->scene.sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i].link == name && sensors[i].joint.empty() && model.sensors[i].reaction >= 0)
      return transmitted_wrench(model, implementation_->state, model.sensors[i].reaction,
                                attached_pose(implementation_->state, model.links[link].frame).position);
  throw std::invalid_argument("the scene has no sensor of kind reaction or wrench for link '" + name + "'");
}
ActingWrench Simulation::sensed_wrench(std::size_t sensor) const {
  const Implementation& s = *implementation_;
  const SensorPlace& place = entry(s.model.sensors, sensor, "sensor");
  if (place.reaction < 0)
    throw std::invalid_argument("sensor '" + s.scene.sensors[sensor].name +
                                "' does not measure a joint's force and moment");
  return {pose_in_world(s.model, s.state, place.point).position, flexarm::sensed_wrench(s.model, s.state, place)};
}
void Simulation::effort_wrenches(std::vector<ActingWrench>& wrenches) const {
  const Implementation& s = *implementation_;
  flexarm::effort_wrenches(s.model, s.state, wrenches);
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    wrenches[i].position += world_origin(s.model, s.state);
    wrenches[i].wrench.force *= effort(i);
    wrenches[i].wrench.moment *= effort(i);
  }
}
void Simulation::outside_wrenches(std::vector<ActingWrench>& wrenches) const {
  const Implementation& s = *implementation_;
  flexarm::outside_wrenches(s.view(), s.published, wrenches);
}
double Simulation::mass() const {
  return mass_of(implementation_->model);
}
void Simulation::contacts(std::vector<ActingContact>& contacts) const {
  const Implementation& s = *implementation_;
  const Vector3 origin = world_origin(s.model, s.state);
  contacts.clear();
  for (const TouchingPair& pair : s.model.touching_pairs)
    touch(pair, s.view(), s.published, [&](const TouchingPoint& point) {
      contacts.push_back(
          {pair.first, pair.second, origin + point.position, point.normal, point.push + point.friction, -point.gap});
    });
}
void Simulation::line_points(std::size_t element, std::vector<Vector3>& points) const {
  const Implementation& s = *implementation_;
  points.clear();
  const std::vector<Vector6> no_velocities;
  const double* memory = s.state.force_memory.data() + memory_begin(s.model.force_elements, element);
  s.model.force_elements.at(element)->put_line({s.state, no_velocities, memory}, points);
  const Vector3 origin = world_origin(s.model, s.state);
  for (Vector3& point : points) point += origin;
}
std::size_t Simulation::most_line_points(std::size_t element) const {
  return implementation_->model.force_elements.at(element)->most_line_points();
}
const SensorSample& Simulation::sample(std::size_t sensor) const {
  return entry(implementation_->state.samples, sensor, "sensor");
}

StaticResult Simulation::solve_static(int load_steps, Equilibrium wanted) {
  if (load_steps < 1) throw std::invalid_argument("the number of load steps must be >= 1");
  implementation_->forget_published();
  Implementation& s = *implementation_;
  StaticResult result =
      flexarm::solve_static(s.model, s.scheme, s.settings, load_steps, wanted, s.state, &s.static_norms);
  s.stepper->invalidate();
  if (result.converged) s.take_samples(true);
  return result;
}

std::vector<Mode> Simulation::natural_modes(int count) const {
  if (count < 1) throw std::invalid_argument("the number of modes must be >= 1");
  std::vector<Mode> modes = flexarm::natural_modes(implementation_->model, implementation_->state, count);
  for (Mode& mode : modes) mode.coordinate_motion.resize(coordinate_names().size());  // without hidden ones
  return modes;
}

std::size_t Simulation::node_count() const {
  return implementation_->model.nodes.size();
}
std::size_t Simulation::degrees_of_freedom() const {
  return implementation_->stepper->degrees_of_freedom().unknowns;
}

}  // namespace flexarm
