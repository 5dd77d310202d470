#include "flexarm/simulation/simulation.h"

#include <cmath>
#include <limits>

#include "flexarm/joints/joint_kinematics.h"
#include "flexarm/math/so3.h"
#include "flexarm/scene/integrator_options.h"

namespace flexarm {
namespace {

StepSettings settings_of(const scene::SceneDescription& scene, const SimulationOptions& options) {
  StepSettings settings;
  settings.step = options.step.value_or(scene.integrator.step);
  settings.tolerance = options.tolerance.value_or(scene.integrator.tolerance);
  settings.max_iterations = scene.integrator.max_iterations;
  settings.max_halvings = scene.integrator.max_halvings;
  settings.reuse_factorisation = options.reuse_factorisation;
  const auto require = [](bool ok, const std::string& what) {
    if (!ok) throw ModelError("<integrator>: " + what);
  };
  require(std::isfinite(settings.step) && settings.step > 0, "step must be > 0");
  require(std::isfinite(settings.tolerance) && settings.tolerance > 0, "tolerance must be > 0");
  require(settings.max_iterations >= 1, "max_iterations must be >= 1");
  require(settings.max_halvings >= 0 && settings.max_halvings <= 30, "max_halvings must be 0 to 30");
  return settings;
}

/// The scene with the scheme and the step in use; the stops' penalty must resolve the latter.
scene::SceneDescription with_options(scene::SceneDescription scene, const SimulationOptions& options) {
  if (options.scheme) scene.integrator = scene::with_scheme(scene.integrator, *options.scheme);
  scene.integrator.step = settings_of(scene, options).step;
  return scene;
}

}  // namespace

struct Simulation::Implementation {
  scene::SceneDescription scene;
  Scheme scheme;
  StepSettings settings;
  Model model;
  Stepper stepper;
  State initial, state;
  std::vector<std::string> coordinate_names, link_names;
  mutable std::vector<NodePose> poses;  // scratch of velocity()
  mutable std::vector<Vector6> velocities;

  Implementation(scene::SceneDescription description, const SimulationOptions& options)
      : scene(with_options(std::move(description), options)),
        scheme(make_scheme(scene.integrator)),
        settings(settings_of(scene, options)),
        model(build_model(scene)),
        stepper(model, scheme, settings),
        initial(initial_state(model)) {
    for (const Coordinate& coordinate : model.coordinates) coordinate_names.push_back(coordinate.name);
    for (const LinkFrame& link : model.links) link_names.push_back(link.name);
    stepper.initialise(initial);
    state = initial;
    poses.resize(model.nodes.size());
    velocities.resize(model.nodes.size());
  }
};

Simulation::Simulation(scene::SceneDescription scene, const SimulationOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(scene), options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const scene::SceneDescription& Simulation::scene() const {
  return implementation_->scene;
}
const Model& Simulation::model() const {
  return implementation_->model;
}
const State& Simulation::state() const {
  return implementation_->state;
}

StepResult Simulation::step() {
  return implementation_->stepper.advance(implementation_->state);
}

void Simulation::reset() {
  implementation_->state = implementation_->initial;
  implementation_->stepper.invalidate();
}

void Simulation::restore(const State& state) {
  const State& mine = implementation_->state;
  if (state.nodes.size() != mine.nodes.size() || state.released.size() != mine.released.size() ||
      state.mass_points.size() != mine.mass_points.size() || state.commands.size() != mine.commands.size())
    throw std::invalid_argument("the state belongs to another model");
  implementation_->state = state;
  implementation_->stepper.invalidate();
}

double Simulation::time() const {
  return implementation_->state.time;
}
double Simulation::step_size() const {
  return implementation_->settings.step;
}
std::string Simulation::scheme() const {
  return std::string(implementation_->scheme.name);
}

// ---------------------------------------------------------------- coordinates

const std::vector<std::string>& Simulation::coordinate_names() const {
  return implementation_->coordinate_names;
}

std::optional<std::size_t> Simulation::find_coordinate(std::string_view name) const {
  const std::vector<std::string>& names = implementation_->coordinate_names;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  return std::nullopt;
}

double Simulation::position(std::size_t index) const {
  const Coordinate& coordinate = implementation_->model.coordinates.at(index);
  const Released& released = implementation_->state.released[coordinate.joint];
  if (!coordinate.is_angle) return released.displacement[coordinate.component];
  return so3::log(released.rotation)[coordinate.component % 3];
}

double Simulation::velocity(std::size_t index) const {
  const Model& model = implementation_->model;
  const Coordinate& coordinate = model.coordinates.at(index);
  const JointMap& joint = model.joints[coordinate.joint];
  const State& state = implementation_->state;
  std::vector<NodePose>& nodes = implementation_->poses;
  std::vector<Vector6>& velocities = implementation_->velocities;
  const auto load = [&](int node) {
    if (node < 0) return;
    nodes[node] = node_pose(state.nodes[node]);
    velocities[node] = spatial_velocity(state.nodes[node]);
  };
  load(joint.slave);
  load(joint.master);
  if (joint.kind == JointMapKind::Slide)
    for (const int node : model.slide_lines[joint.line].nodes) load(node);
  return released_rates(model, coordinate.joint, nodes, state.released[coordinate.joint],
                        velocities)[coordinate.component];
}

double Simulation::effort(std::size_t index) const {
  return implementation_->state.efforts.at(index);
}

void Simulation::command_effort(std::size_t index, double effort) {
  if (!std::isfinite(effort)) throw std::invalid_argument("a commanded effort must be finite");
  if (!is_commandable(index))
    throw std::invalid_argument("joint coordinate '" + coordinate_names()[index] + "' cannot be commanded");
  implementation_->state.commands[index] = effort;
}

void Simulation::release_command(std::size_t index) {
  implementation_->state.commands.at(index) = std::numeric_limits<double>::quiet_NaN();
}

bool Simulation::is_commandable(std::size_t index) const {
  const Coordinate& coordinate = implementation_->model.coordinates.at(index);
  return coordinate.motion < 0 && coordinate.mimicked < 0;
}

// ---------------------------------------------------------------- frames

const std::vector<std::string>& Simulation::link_names() const {
  return implementation_->link_names;
}

Pose Simulation::link_pose(std::size_t link) const {
  return attached_pose(implementation_->state, implementation_->model.links.at(link).frame);
}

bool Simulation::is_flexible(std::size_t link) const {
  return implementation_->model.links.at(link).beam.has_value();
}

Pose Simulation::tip_pose(std::size_t link) const {
  const LinkFrame& frame = implementation_->model.links.at(link);
  return frame.beam ? attached_pose(implementation_->state, frame.beam->tip) : link_pose(link);
}

void Simulation::beam_points(std::size_t link, int between, std::vector<BeamPoint>& points) const {
  const LinkFrame& frame = implementation_->model.links.at(link);
  if (frame.beam) flexarm::beam_points(implementation_->model, implementation_->state, *frame.beam, between, points);
}

double Simulation::beam_radius(std::size_t link) const {
  const LinkFrame& frame = implementation_->model.links.at(link);
  return frame.beam ? frame.beam->radius : 0.0;
}

// ---------------------------------------------------------------- observables and analyses

Energies Simulation::energies() const {
  return flexarm::energies(implementation_->model, implementation_->scheme, implementation_->state);
}
Vector3 Simulation::momentum() const {
  return momenta(implementation_->model, implementation_->scheme, implementation_->state).linear;
}
Vector3 Simulation::angular_momentum() const {
  return momenta(implementation_->model, implementation_->scheme, implementation_->state).angular;
}
ProbeState Simulation::probe(std::size_t index) const {
  return probe_state(implementation_->model, implementation_->state, implementation_->model.probes.at(index));
}

StepResult Simulation::solve_static(int load_steps) {
  if (load_steps < 1) throw std::invalid_argument("the number of load steps must be >= 1");
  return implementation_->stepper.solve_static(implementation_->state, load_steps);
}

std::vector<Mode> Simulation::natural_modes(int count) const {
  if (count < 1) throw std::invalid_argument("the number of modes must be >= 1");
  return flexarm::natural_modes(implementation_->model, implementation_->state, count);
}

std::size_t Simulation::node_count() const {
  return implementation_->model.nodes.size();
}
std::size_t Simulation::degrees_of_freedom() const {
  return implementation_->stepper.degrees_of_freedom().unknowns;
}
const std::vector<double>& Simulation::update_norms() const {
  return implementation_->stepper.update_norms();
}

}  // namespace flexarm
