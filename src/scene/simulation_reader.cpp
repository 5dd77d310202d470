#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/schemes/integrator_description.h"
#include "scene/limits.h"
#include "scene/readers.h"

namespace flexarm::scene {
namespace {

constexpr NumberRange kPart{"between 0 and 1", [](double x) { return x > 0 && x < 1; }};
constexpr NumberRange kUnitInterval{"from 0 to 1", [](double x) { return x >= 0 && x <= 1; }};

constexpr NumberRange kStep{"> 0 and at most 1e9", [](double x) { return x > 0 && x <= kLongestStep; }};
constexpr NumberRange kTolerance{"> 0 and at most 1", [](double x) { return x > 0 && x <= kLargestTolerance; }};

/// alpha of the HHT method.
constexpr NumberRange kHhtRange{"from -1/3 to 0", [](double x) { return x >= -1.0 / 3 && x <= 0; }};

std::optional<Interpolation> read_interpolation(const XmlElement& integrator) {
  const std::string name = integrator.text("interpolation").value_or("");
  if (name == "local") return Interpolation::Local;
  if (name == "total") return Interpolation::Total;
  if (name == "incremental") return Interpolation::Incremental;
  if (name == "iterative") return Interpolation::Iterative;
  integrator.attribute_error("interpolation", "interpolation must be one of local, total, incremental, iterative");
  return std::nullopt;
}

std::optional<WeakForm> read_weak_form(const XmlElement& integrator) {
  const std::string name = integrator.text("weak_form").value_or("");
  if (name == "spin") return WeakForm::Spin;
  if (name == "additive") return WeakForm::Additive;
  integrator.attribute_error("weak_form", "weak_form must be 'spin' or 'additive'");
  return std::nullopt;
}

void read_scheme(const XmlElement& integrator, IntegratorDescription& description) {
  if (integrator.has("scheme")) {
    const std::string name = integrator.text("scheme").value_or("");
    const std::vector<std::string_view>& known = scheme_names();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      integrator.attribute_error("scheme", fmt::format("scheme must be one of {}", fmt::join(known, ", ")));
      return;
    }
    description.scheme = name;
  }
  if (integrator.has("interpolation")) description.interpolation = read_interpolation(integrator);
  if (integrator.has("weak_form")) description.weak_form = read_weak_form(integrator);
  // Newmark's method divides by beta; with beta = 0 it is explicit, which is another algorithm.
  if (integrator.has("beta")) description.beta = integrator.number("beta", kPositive);
  if (integrator.has("gamma")) description.gamma = integrator.number("gamma", kPositive);
  if (integrator.has("alpha")) description.alpha = integrator.number("alpha", kHhtRange);
  if (integrator.has("rho_infinity")) description.rho_infinity = integrator.number("rho_infinity", kUnitInterval);
  constexpr Choice<OnFailure> kOnFailure[] = {{"stop", OnFailure::Stop}, {"dissipate", OnFailure::Dissipate}};
  description.on_failure = read_choice(integrator, "on_failure", kOnFailure, description.on_failure);
  for (const OptionConflict& conflict : option_conflicts(description))
    integrator.attribute_error(conflict.attribute.c_str(), conflict.message);
}

void read_integrator(const XmlElement& integrator, SceneDescription& scene) {
  IntegratorDescription& description = scene.integrator;
  scene.integrator_location = integrator.location();
  integrator.expect_only({"scheme", "step", "tolerance", "max_iterations", "max_halvings", "interpolation", "weak_form",
                          "beta", "gamma", "alpha", "rho_infinity", "on_failure", "accuracy", "dimension"});
  read_scheme(integrator, description);
  description.step = integrator.number("step", kStep, description.step);
  description.tolerance = integrator.number("tolerance", kTolerance, description.tolerance);
  if (integrator.has("accuracy")) description.accuracy = integrator.number("accuracy", kPart);
  if (integrator.has("max_iterations"))
    description.max_iterations = integrator.integer("max_iterations", 1, kMostNewtonIterations).value_or(1);
  if (integrator.has("max_halvings"))
    description.max_halvings = integrator.integer("max_halvings", 0, kMostHalvings).value_or(0);
  constexpr Choice<bool> kDimension[] = {{"auto", true}, {"3", false}};
  description.may_be_planar = read_choice(integrator, "dimension", kDimension, description.may_be_planar);
}

void read_gravity(const XmlElement& gravity, SceneDescription& scene) {
  gravity.expect_only({"xyz"});
  scene.gravity = gravity.vector("xyz").value_or(scene.gravity);
}

/// Reads `position`: a number, or "clamp". For "clamp" returns 0; settle_positions() replaces it when the joint's
/// limits are known.
double read_initial_position(const XmlElement& initial, const std::string& coordinate, StartRequest& start) {
  if (!initial.has("position")) return 0;
  if (initial.text("position") == "clamp") {
    start.clamped.insert(coordinate);
    return 0;
  }
  start.placed.insert(coordinate);
  return initial.number("position", kAnyNumber, 0);
}

constexpr Choice<bool> kTruth[] = {{"true", true}, {"false", false}};

void read_initial(const XmlElement& initial, SceneDescription& scene, StartRequest& start) {
  if (initial.has("equilibrium")) {
    initial.expect_only({"equilibrium"});
    scene.starts_in_equilibrium = read_choice(initial, "equilibrium", kTruth, false) || scene.starts_in_equilibrium;
    scene.equilibrium_location = initial.location();
    return;
  }
  const bool of_link = initial.has("link");
  if (of_link == initial.has("joint")) {
    initial.error("one of the attributes 'joint', 'link' and 'equilibrium' is expected");
    return;
  }
  if (of_link) {
    initial.expect_only({"link", "linear", "angular"});
    if (!initial.has("linear") && !initial.has("angular")) initial.error("attribute 'linear' or 'angular' is missing");
    scene.initial_links.push_back({initial.name("link").value_or(""), initial.vector("linear", Vector3::Zero()),
                                   initial.vector("angular", Vector3::Zero()), initial.location()});
  } else {
    initial.expect_only({"joint", "position", "velocity"});
    if (!initial.has("position") && !initial.has("velocity"))
      initial.error("attribute 'position' or 'velocity' is missing");
    const std::string coordinate = initial.name("joint").value_or("");
    const double position = read_initial_position(initial, coordinate, start);
    scene.initial_joints.push_back(
        {coordinate, position, initial.number("velocity", kAnyNumber, 0), initial.location(), initial.has("velocity")});
  }
}

LoadFrame read_frame(const XmlElement& load) {
  if (!load.has("frame")) return LoadFrame::World;
  const std::string frame = load.text("frame").value_or("");
  if (frame != "world" && frame != "follower") load.attribute_error("frame", "frame must be 'world' or 'follower'");
  return frame == "follower" ? LoadFrame::Follower : LoadFrame::World;
}

TimeFunction read_history(const XmlElement& load) {
  return load.has("history") ? load.function("history").value_or(TimeFunction()) : TimeFunction();
}

void read_load(const XmlElement& load, SceneDescription& scene) {
  load.expect_only({"link", "at", "force", "moment", "frame", "history"});
  if (!load.has("force") && !load.has("moment")) load.error("attribute 'force' or 'moment' is missing");
  const Vector3 zero = Vector3::Zero();
  scene.loads.push_back({load.name("link").value_or(""), load.vector("at", zero), load.vector("force", zero),
                         load.vector("moment", zero), read_frame(load), read_history(load), load.location()});
}

void read_distributed_load(const XmlElement& load, SceneDescription& scene) {
  load.expect_only({"link", "force", "frame", "history", "from", "to"});
  const auto arc_length = [&](const char* attribute) {
    return load.has(attribute) ? load.number(attribute, kNonNegative) : std::nullopt;
  };
  const std::optional<double> from = arc_length("from"), to = arc_length("to");
  if (to && *to <= from.value_or(0)) load.attribute_error("to", "to must be > from, along the line");
  scene.distributed_loads.push_back({load.name("link").value_or(""), load.vector("force").value_or(Vector3::Zero()),
                                     read_frame(load), read_history(load), load.location(), from, to});
}

void read_motion(const XmlElement& motion, SceneDescription& scene) {
  motion.expect_only({"joint", "position"});
  scene.motions.push_back(
      {motion.name("joint").value_or(""), motion.function("position").value_or(TimeFunction()), motion.location()});
}

void read_effort(const XmlElement& effort, SceneDescription& scene) {
  effort.expect_only({"joint", "history"});
  scene.efforts.push_back(
      {effort.name("joint").value_or(""), effort.function("history").value_or(TimeFunction()), effort.location()});
}

void read_probe(const XmlElement& probe, SceneDescription& scene) {
  probe.expect_only({"name", "link", "at"});
  scene.probes.push_back({probe.name("name").value_or(""), probe.name("link").value_or(""),
                          probe.vector("at", Vector3::Zero()), probe.location()});
}

constexpr Choice<bool> kRootTypes[] = {{"clamped", false}, {"floating", true}};
constexpr Choice<bool> kStarts[] = {{"given", false}, {"clamp", true}};
constexpr Choice<bool> kMassless[] = {{"refuse", false}, {"lock", true}};

void read_root(const XmlElement& root, StartRequest& start) {
  root.expect_only({"type"});
  start.root = {read_choice(root, "type", kRootTypes).value_or(false), root.location()};
}

}  // namespace

void read_simulation(const XmlElement& unowned, SceneDescription& scene, StartRequest& start) {
  const XmlElement simulation = unowned.with_owner("simulation");
  simulation.expect_only({"start", "massless", "contact_time"}, {"gravity", "integrator", "root", "initial", "load",
                                                                 "distributed_load", "motion", "effort", "probe"});
  simulation.expect_at_most_one({"gravity", "integrator", "root"});
  start.clamps_all = read_choice(simulation, "start", kStarts, false) || start.clamps_all;
  scene.lock_massless = read_choice(simulation, "massless", kMassless, false) || scene.lock_massless;
  scene.contact_time = simulation.number("contact_time", kPositive, scene.contact_time);
  const std::vector<XmlElement> entries = simulation.children();
  if (entries.size() > kMostSimulationEntries) {
    simulation.error(fmt::format("at most {} entries are allowed", kMostSimulationEntries),
                     fmt::format("'{}'", entries.size()));
    return;
  }
  for (const XmlElement& entry : entries) {
    const std::string tag = entry.tag();
    if (tag == "gravity") read_gravity(entry, scene);
    if (tag == "integrator") read_integrator(entry, scene);
    if (tag == "root") read_root(entry, start);
    if (tag == "initial") read_initial(entry, scene, start);
    if (tag == "load") read_load(entry, scene);
    if (tag == "distributed_load") read_distributed_load(entry, scene);
    if (tag == "motion") read_motion(entry, scene);
    if (tag == "effort") read_effort(entry, scene);
    if (tag == "probe") read_probe(entry, scene);
  }
}

}  // namespace flexarm::scene
