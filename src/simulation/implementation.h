#pragma once
/// The private data of a Simulation.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "building/cylinder_places.h"
#include "building/model_builder.h"
#include "building/places_at_start.h"
#include "building/rigid_lines.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/energies.h"
#include "integrators/stepper.h"
#include "math/step_end.h"
#include "model/carried_origin.h"
#include "model/line_release.h"
#include "model/room_for_wrenches.h"
#include "simulation/entry.h"
#include "simulation/failure_text.h"
#include "simulation/joint_state.h"
#include "simulation/loop_velocities.h"
#include "simulation/mesh_change.h"
#include "simulation/observables.h"
#include "simulation/published_motion.h"
#include "simulation/refinement.h"
#include "simulation/sensors.h"
#include "simulation/settings.h"
#include "simulation/start.h"
#include "simulation/state_flaw.h"

namespace flexarm {

struct Simulation::Implementation {
  scene::SceneDescription scene;
  Scheme scheme;
  IntegratorDescription first_integrator;  ///< from which `scheme` was made and the initial state was found
  double step_of_constants;                ///< from which `scheme` has its constants [s]
  StepSettings settings;
  std::vector<std::optional<RigidLine>> rigid_lines;  ///< per link
  Model model;
  /// Set once a slider has left its line or elements were halved: the model as the scene describes it.
  std::unique_ptr<const Model> built;
  bool is_refined;  ///< whether elements may be halved
  std::unique_ptr<Stepper> stepper;
  std::shared_ptr<const State> initial;  ///< shared by this simulation and its copies
  State state;
  std::vector<std::string> coordinate_names, link_names;
  std::map<std::string, std::size_t, std::less<>> coordinate_indices;  ///< by name
  // Results computed from `state`, kept for further requests.
  mutable PublishedMotion published;
  mutable std::optional<Energies> energies;
  mutable std::optional<Momenta> momenta;
  State before_part;                       // if elements may be halved: at the beginning of a part of a step
  double rest_before_part = 0;             // what was left of the step there [s]
  std::vector<NodalLoad> placed_wrenches;  // scratch
  std::vector<double> static_norms;        // update norms of the last solve for an equilibrium; empty after steps
  scene::Diagnostics start_warnings;

  Implementation(scene::SceneDescription description, const SimulationOptions& options)
      : Implementation(place_cylinders(with_options(std::move(description), options)), options) {}

  Implementation(PlacedScene placed, const SimulationOptions& options)
      : scene(std::move(placed.scene)),
        scheme(made_for_integrator(scene, [&] { return make_scheme(scene.integrator); })),
        first_integrator(scene.integrator),
        step_of_constants(first_integrator.step),
        settings(settings_of(scene, options)),
        model(build_model(scene, &rigid_lines)),
        is_refined(refines(model)),
        stepper(made_for_integrator(scene, [&] { return std::make_unique<Stepper>(model, scheme, settings); })),
        state(initial_state(model)),
        start_warnings(std::move(placed.warnings)) {
    require_suitable_slides(scene, scheme);
    require_suitable_refinement(scene, scheme, model);
    for (const scene::Diagnostics& found :
         {held_joints(scene, model), open_loops(scene, model), joints_beyond_beams(scene), hidden_inertia(scene, model),
          doubts_about_scheme(scene, model, scheme)})
      start_warnings.insert(start_warnings.end(), found.begin(), found.end());
    const std::set<std::string> hidden = hidden_coordinates(scene);
    for (const Coordinate& coordinate : model.coordinates) {
      if (hidden.count(coordinate.name) > 0) break;  // the last ones
      coordinate_indices.emplace(coordinate.name, coordinate_names.size());
      coordinate_names.push_back(coordinate.name);
    }
    for (const LinkFrame& link : model.links) link_names.push_back(link.name);
    make_room();
    const StepResult found = stepper->initialise(state);
    if (scene.starts_in_equilibrium)
      start_in_equilibrium(scene, model, scheme, settings, state, start_warnings);
    else if (!found.converged)
      start_warnings.push_back(unknown_accelerations(scene, failure_text(model, settings, found)));
    if (!scene.starts_in_equilibrium)
      for (scene::Diagnostic& overlap : overlaps(scene, model, state)) start_warnings.push_back(std::move(overlap));
    published.velocities(view());  // so that its memory is allocated at the start
    take_samples(true);
    initial = std::make_shared<const State>(state);
  }

  Implementation(const Implementation& other)
      : scene(other.scene),
        scheme(other.scheme),
        first_integrator(other.first_integrator),
        step_of_constants(other.step_of_constants),
        settings(other.settings),
        rigid_lines(other.rigid_lines),
        model(other.model),
        built(other.built ? std::make_unique<const Model>(*other.built) : nullptr),
        is_refined(other.is_refined),
        stepper(std::make_unique<Stepper>(model, scheme, settings)),
        initial(other.initial),
        state(other.state),
        coordinate_names(other.coordinate_names),
        link_names(other.link_names),
        coordinate_indices(other.coordinate_indices),
        static_norms(other.static_norms),
        start_warnings(other.start_warnings) {
    make_room();
  }

  /// Reserves memory for wrenches, since threads that must not allocate memory apply them.
  void make_room() {
    placed_wrenches.reserve(kRoomForWrenches);
    state.wrenches.reserve(kRoomForWrenches);
  }

  /// The end of the link's beam; if it has no beam, the link's frame.
  Attachment tip(std::size_t link) const {
    const LinkFrame& frame = entry(model.links, link, "link");
    if (frame.beam) return frame.beam->tip;
    if (!rigid_lines[link]) return frame.frame;
    const Vector3& end = rigid_lines[link]->sections.back().position;
    return {frame.frame.node, frame.frame.offset * Pose{end, Quaternion::Identity()}};
  }

  void forget_published() {
    published.forget();
    energies.reset();
    momenta.reset();
  }

  const Energies& published_energies() const {
    if (!energies) energies = flexarm::energies(model, scheme, state);
    return *energies;
  }
  const Momenta& published_momenta() const {
    if (!momenta) momenta = flexarm::momenta(model, scheme, state);
    return *momenta;
  }

  MotionView view() const { return {model, stepper->degrees_of_freedom(), scheme, state}; }

  void take_samples(bool all) { flexarm::take_samples(scene.sensors, view(), published, all, state.samples); }

  /// Converts a pose relative to the state's origin to one in the world.
  Pose in_world(const Pose& pose) const { return {world_origin(model, state) + pose.position, pose.orientation}; }
  Pose in_world(const Attachment& frame) const {
    const Pose pose = attached_pose(state, frame);
    return frame.node < 0 ? Pose{model.origin + pose.position, pose.orientation} : in_world(pose);
  }

  /// Makes a step. Sliders that leave their lines in it become free at that time, and elements that are strongly bent
  /// are halved.
  StepResult advance() {
    const double end = step_end(state.time, settings.step);
    if (is_refined) {
      if (state.steps % kStepsBetweenJoins == 0) join_straight();
      before_part = state;
      rest_before_part = settings.step;
    }
    StepResult result = advance_part();
    double rest = stepper->rest();
    while (change_model(result, rest) && rest > 0) {
      stepper->set_step(rest, settings.events);
      StepResult last = advance_part();
      last.add_effort(result);
      result = last;
      rest = stepper->rest();
      stepper->set_step(settings.step, settings.events);
      if (result.converged && rest == 0) state.time = end;
    }
    return result;
  }

  StepResult advance_part() {
    if (!is_refined) return stepper->advance_until(state);
    return stepper->advance_until(state,
                                  [this](const State& now) { return bending_of(model, now) != Bending::Little; });
  }

  /// Changes the model if the part of a step that has ended with `result` requires it. Returns whether it does.
  /// `rest`: what is left of the step [s]; on output more if the part has to be repeated with elements halved.
  bool change_model(const StepResult& result, double& rest) {
    const bool is_released = release_from_lines();
    if (is_released && rest > 0) state.halving_level = state.good_steps = 0;
    return halve_bent(result, rest) || is_released;
  }

  bool halve_bent(const StepResult& result, double& rest) {
    const Bending bending = is_refined ? bending_of(model, state) : Bending::Little;
    if (bending == Bending::Little || result.reason == StepResult::Reason::OutOfTime) return false;
    const std::vector<HalvedElement> halved = with_bent_halved(model, state);
    const bool goes_on = bending == Bending::Strong && result.converged;
    if (goes_on) {
      const double sub_step = std::ldexp(rest_before_part, -state.halving_level);
      before_part = state;
      before_part.halving_level = rest > sub_step ? static_cast<int>(std::ceil(std::log2(rest / sub_step))) : 0;
      rest_before_part = rest;
    }
    go_on_with_mesh(halved, before_part);
    before_part = state;
    rest = rest_before_part;
    return true;
  }

  /// Joins halves that are nearly straight: as many as the energy allows, the straightest ones first.
  void join_straight() {
    const std::vector<HalvedElement> straight = straight_elements(model, state);
    if (straight.empty()) return;
    before_part = state;
    const Energies before = flexarm::energies(model, scheme, state);
    for (std::size_t count = straight.size(); count > 0; count /= 2) {
      std::vector<HalvedElement> rest;
      const auto joined_end = straight.begin() + static_cast<std::ptrdiff_t>(count);
      std::copy_if(
          before_part.halved.begin(), before_part.halved.end(), std::back_inserter(rest),
          [&](const HalvedElement& one) { return std::find(straight.begin(), joined_end, one) == joined_end; });
      go_on_with_mesh(rest, before_part);
      if (is_small_change(before, flexarm::energies(model, scheme, state))) return;
    }
    set_state(before_part);
  }

  /// Continues `begin`, a state of the present model or of that before sliders left their lines, with these halvings.
  void go_on_with_mesh(const std::vector<HalvedElement>& halved, const State& begin) {
    fit_to_state(begin);
    const Model before = model;
    State wanted;
    wanted.halved = halved;
    wanted.left_lines = begin.left_lines;
    wanted.released = begin.released;
    fit_to_state(wanted);
    state = on_changed_mesh(before, begin, model, scheme);
    make_room();
  }

  /// Frees the sliders that are beyond the end of a line that they may leave. Returns whether there was one.
  bool release_from_lines() {
    bool is_released = false;
    for (int slide; (slide = slide_beyond_end(model, state)) >= 0; is_released = true) {
      State released = state_after_release(model, state, slide);
      if (!built) built = std::make_unique<const Model>(model);
      set_model(model_after_release(model, state, slide));
      state = std::move(released);
    }
    return is_released;
  }

  void set_model(Model changed) {
    model = std::move(changed);
    stepper = std::make_unique<Stepper>(model, scheme, settings);
  }

  /// Makes the model one in which the same elements as in `other` are halved, and the same sliders have left their
  /// lines.
  void fit_to_state(const State& other) {
    const bool is_same_mesh = other.halved == model.halved;
    if (is_same_mesh && other.left_lines == state.left_lines) return;
    if (!is_same_mesh) {
      set_halved(other.halved, scene);
      built = std::make_unique<const Model>(build_model(scene));
    } else if (!built) {
      built = std::make_unique<const Model>(model);
    }
    Model changed = *built;
    for (const int slide : other.left_lines) changed = model_after_release(std::move(changed), other, slide);
    set_model(std::move(changed));
    state.left_lines = other.left_lines;
  }

  void set_state(const State& other) {
    fit_to_state(other);
    state = other;
    forget_published();
    stepper->invalidate();
  }

  /// Converts the state of another simulation of the same mechanism to a state of this one.
  State state_of_other(const Implementation& from) {
    fit_to_state(from.state);
    const bool is_same = from.scheme.name == scheme.name;
    if (is_same && from.settings.step == settings.step) return from.state;
    const DegreesOfFreedom& dof = stepper->degrees_of_freedom();
    const State closed = with_closed_loops(model, dof, from.state);
    State state = is_same ? closed : with_joint_state(model, dof, closed, {});
    state.halving_level = state.good_steps = 0;
    state.drives = from.state.drives;
    state.transmitted = from.state.transmitted;
    state.last_transmitted = from.state.last_transmitted;
    if (is_same) return state;
    // The nodes keep the motion that they have, rather than the one that follows from the joints' rates: a scheme may
    // let slaves deviate a little from their joints.
    for (std::size_t i = 0; i < state.nodes.size(); ++i) {
      const NodeState& node = closed.nodes[i];
      state.nodes[i] = {node.position, node.orientation, node.velocity, node.angular_velocity};
    }
    state.released = from.state.released;
    if (!scheme.is_incremental() && !from.scheme.is_incremental()) state.study.mass_points = closed.study.mass_points;
    if (initial->study.total_rotations.empty()) state.study.total_rotations.clear();
    begin(state);
    return state;
  }

  /// Adds to a state at which a motion begins what the scheme stores there, such as accelerations.
  /// @throws std::invalid_argument if accelerations cannot be found
  void begin(State& state) {
    const StepResult found = stepper->initialise(state);
    if (!found.converged)
      throw std::invalid_argument("its accelerations cannot be found: " + failure_text(model, settings, found));
  }

  void set_step(double step, const EventSearch& events) {
    if (step == settings.step && events == settings.events) return;
    settings.step = step;
    settings.events = events;
    stepper->set_step(step, events);
    state.halving_level = state.good_steps = 0;
  }

  void set_step_of_constants(double step) {
    if (step == step_of_constants) return;
    step_of_constants = step;
    const bool blurs_touches = !scheme.is_incremental() && !scheme.tableau && has_stops(model);
    if (state.strain_memory.empty() && !blurs_touches) return;  // nothing depends on these constants
    Scheme changed = scheme;
    take_constants_of_step(changed, first_integrator, step);
    const double gain =
        flexarm::energies(model, changed, state).strain - flexarm::energies(model, scheme, state).strain;
    (gain > 0 ? state.work : state.dissipated) += std::abs(gain);
    scheme = changed;
    stepper = std::make_unique<Stepper>(model, scheme, settings);
    forget_published();
  }

  void restore(const State& other) {
    std::string flaw = halving_flaw(model, other.halved);
    const bool is_other_mesh = flaw.empty() && other.halved != model.halved;
    const State kept = is_other_mesh ? state : State();
    if (is_other_mesh) take_mesh(other.halved);
    const Model& whole = built ? *built : model;
    if (flaw.empty())
      flaw = state_flaw(whole, whole.halved == initial->halved ? *initial : sized_for(whole, *initial),
                        finest_halving(settings), other);
    if (!flaw.empty()) {
      if (is_other_mesh) set_state(kept);
      throw std::invalid_argument("not a state of this scene: " + flaw);
    }
    set_state(other);
  }

  /// Takes the mesh with these halvings; the state's numbers mean nothing until a state is restored: halving_flaw().
  void take_mesh(const std::vector<HalvedElement>& halved) {
    State other = *initial;
    other.halved = halved;
    fit_to_state(other);
    set_state(sized_for(model, *initial));
  }
};

}  // namespace flexarm
