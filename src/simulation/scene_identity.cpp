#include "simulation/scene_identity.h"

#include <algorithm>
#include <map>
#include <memory>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "schemes/scheme.h"
#include "simulation/fingerprint.h"

namespace flexarm {
namespace {

/// Reads parts of a scene, and collects their fingerprint and their values by name. Most structures are taken apart by
/// structured bindings: if a structure gets a new member, this file does not compile until somebody decides whether
/// that member counts.
class SceneParts {
 public:
  /// `path`: name of the part that follows, such as "link 'arm'".
  SceneParts(std::string path, std::vector<SceneValue>& values) : path_(std::move(path)), values_(values) {}

  /// Takes names and parts alternately.
  template <class Part, class... Others>
  void all(const char* name, const Part& part, const Others&... others) {
    const std::size_t length = path_.size();
    path_ += std::string(" ") + name;
    add(part);
    path_.resize(length);
    if constexpr (sizeof...(others) > 0) all(others...);
  }
  template <class Part>
  void add_part(const Part& part) {
    add(part);
  }
  std::string fingerprint() const { return bytes_.text(); }

 private:
  // ---- the fingerprint and the list of values
  void count(double value) {
    value += 0.0;  // -0 and 0 are the same
    bytes_.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  /// Adds a value to the list, in one line, even if the text has several.
  void tell(std::string value) {
    std::string name = path_;
    for (std::string* text : {&name, &value})
      std::replace_if(
          text->begin(), text->end(), [](unsigned char c) { return c < 0x20; }, ' ');
    values_.push_back({std::move(name), std::move(value)});
  }
  /// What distinguishes a member of a list from the others: its coordinate, its name, or its number.
  template <class Value>
  static auto label(const Value& value, std::size_t, int) -> decltype(value.coordinate, std::string()) {
    return "'" + value.coordinate + "'";
  }
  template <class Value>
  static auto label(const Value& value, std::size_t, int) -> decltype(value.name, std::string()) {
    return "'" + value.name + "'";
  }
  template <class Value>
  static std::string label(const Value&, std::size_t index, long) {
    return std::to_string(index + 1);
  }

  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>, int> = 0>
  void add(Number number) {
    count(static_cast<double>(number));
    tell(fmt::format("{}", static_cast<double>(number) + 0.0));
  }
  void add(const std::string& text) {
    count(static_cast<double>(text.size()));
    bytes_.add(text);
    tell(text);
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    std::string told;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        count(matrix(i, j));
        told += (told.empty() ? "" : " ") + fmt::format("{}", matrix(i, j) + 0.0);
      }
    tell(told);
  }
  void add(const std::vector<double>& numbers) {
    count(static_cast<double>(numbers.size()));
    for (const double number : numbers) count(number);
    tell(fmt::format("{}", fmt::join(numbers, " ")));
  }
  template <class Value>
  void add(const std::optional<Value>& value) {
    count(value.has_value());
    if (value) add(*value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    count(static_cast<double>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) all(label(values[i], i, 0).c_str(), values[i]);
  }
  template <class... Values>
  void add(const std::variant<Values...>& value) {
    count(static_cast<double>(value.index()));
    std::visit([&](const auto& held) { add(held); }, value);
  }
  void add(const TimeFunction& function) { add(function.text()); }
  void add(const Pose& pose) { all("position", pose.position, "quaternion", pose.orientation.coeffs()); }

  // ---- beams
  void add(const scene::Circle& circle) { all("radius", circle.radius); }
  void add(const scene::Tube& tube) { all("outer_radius", tube.outer_radius, "inner_radius", tube.inner_radius); }
  void add(const scene::Rectangle& rectangle) { all("width", rectangle.width, "height", rectangle.height); }
  void add(const scene::BoxTube& box) { all("width", box.width, "height", box.height, "thickness", box.thickness); }
  void add(const scene::GeometricSection& section) {
    const auto& [young, poisson, density] = section.material;
    all("shape", section.shape, "young", young, "poisson", poisson, "density", density);
  }
  void add(const scene::DirectSection& section) {
    const auto& [ea, ga2, ga3, gj, ei2, ei3, mass, j1, j2, j3] = section;
    all("ea", ea, "ga2", ga2, "ga3", ga3, "gj", gj, "ei2", ei2, "ei3", ei3, "mass", mass, "j1", j1, "j2", j2, "j3", j3);
  }
  void add(const scene::MatrixSection& section) { all("stiffness", section.stiffness, "inertia", section.inertia); }
  void add(const scene::SectionStations& stations) {
    all("arc_lengths", stations.arc_lengths, "sections", stations.sections);
  }
  void add(const scene::CentrelinePiece& piece) {
    const auto& [kind, to, center, twist, location] = piece;
    all("kind", kind, "to", to, "center", center, "twist", twist);
  }
  void add(const scene::HubDescription& hub) { all("end", hub.end, "mass", hub.mass, "inertia", hub.inertia); }
  void add(const scene::BeamDescription& beam) {
    const auto& [elements, order, refine, halved, centreline, section_y, section, stiffness_damping, damping_shares,
                 mass_damping, maxwell, prestrain, hubs, location] = beam;
    all("elements", elements, "order", order, "centreline", centreline, "section_y", section_y, "section", section,
        "stiffness_damping", stiffness_damping, "mass_damping", mass_damping, "hubs", hubs);
    if (refine.value_or(false)) all("refine", true);
    if (damping_shares != Vector6::Ones()) all("damping_shares", damping_shares);
    for (const auto& [modulus_ratio, relaxation_time] : maxwell)
      all("modulus_ratio", modulus_ratio, "relaxation_time", relaxation_time);
    for (std::size_t i = 0; i < prestrain.size(); ++i)
      if (prestrain[i]) all("prestrain number", i, "prestrain", *prestrain[i]);
  }

  // ---- links and joints
  void add(const scene::RigidInertia& inertia) {
    all("mass", inertia.mass, "center_of_mass", inertia.center_of_mass, "inertia", inertia.inertia);
  }
  void add(const scene::DragDescription& drag) {
    const auto& [coefficient, density, area, at, location] = drag;
    all("coefficient", coefficient, "density", density, "area", area, "at", at);
  }
  void add(const scene::LinkDescription& link) {
    const auto& [name, inertial, beam, visuals, collisions, location, drag] = link;
    all("name", name, "inertial", inertial, "beam", beam);
    if (drag) all("drag", *drag);
  }
  /// Adds an option only if the scene gives it, so that scenes without the option keep the fingerprints of older
  /// versions.
  void add_given(const char* name, const std::optional<double>& value) {
    if (value) all(name, *value);
  }
  void add(const scene::JointLimits& limits) {
    all("lower", limits.lower, "upper", limits.upper);
    add_given("restitution", limits.restitution);
    add_given("contact_time", limits.contact_time);
    add_given("stiffness", limits.stiffness);
  }
  void add(const scene::Mimic& mimic) {
    all("joint", mimic.joint, "multiplier", mimic.multiplier, "offset", mimic.offset);
  }
  void add(const scene::SlideDescription& slide) {
    const auto& [start, rotation, on_end, scheme, smooth, offset, restitution, location] = slide;
    all("start", start, "rotation", rotation, "on_end", on_end, "scheme", scheme, "smooth", smooth, "offset", offset);
    add_given("restitution", restitution);
  }
  void add(const scene::FrictionDescription& friction) {
    const auto& [law, coefficient, radius, static_ratio, stribeck_speed] = friction;
    all("law", law, "coefficient", coefficient, "radius", radius);
    if (static_ratio != 1) all("static", static_ratio, "stribeck", stribeck_speed);
  }
  void add(const scene::JointDescription& joint) {
    const auto& [name, kind, parent, child, origin, axis, axis2, ratio, offset, direction, profile, slide, limits,
                 effort_limit, damping, friction, friction_law, mimic, child_origin, location, is_hidden] = joint;
    all("name", name, "kind", kind, "parent", parent, "child", child, "origin", origin, "axis", axis, "axis2", axis2,
        "ratio", ratio, "offset", offset, "direction", direction, "slide", slide, "limits", limits, "effort_limit",
        effort_limit, "damping", damping, "friction", friction, "friction_law", friction_law, "mimic", mimic,
        "child_origin", child_origin);
    if (profile) all("profile", profile->numbers());
  }

  /// Its parts are links and joints of the scene; this is what their places follow from.
  void add(const scene::CylinderDescription& cylinder) {
    all("name", cylinder.name, "from", cylinder.from, "from_at", cylinder.from_at, "to", cylinder.to, "to_at",
        cylinder.to_at);
  }

  void add(const scene::SpringDescription& spring) {
    all("coordinate", spring.coordinate, "stiffness", spring.stiffness, "rest", spring.rest);
    if (spring.damping_ratio > 0) all("damping_ratio", spring.damping_ratio);
  }
  void add(const scene::DriveDescription& drive) {
    const auto& [coordinate, gear, rotor_inertia, stiffness, damping, damping_ratio, backlash, friction, efficiency,
                 effort_limit, velocity_limit, axis, location] = drive;
    all("coordinate", coordinate, "gear", gear, "rotor_inertia", rotor_inertia, "stiffness", stiffness, "damping",
        damping, "backlash", backlash, "friction", friction, "efficiency", efficiency, "effort_limit", effort_limit,
        "velocity_limit", velocity_limit, "axis", axis);
    if (damping_ratio > 0) all("damping_ratio", damping_ratio);
  }
  void add(const scene::ServoDescription& servo) {
    const auto& [coordinate, mode, kp, kd, ki, set_point, feedforward, effort_limit, anti_windup, side, sample_time,
                 delay, other_modes, location] = servo;
    all("coordinate", coordinate, "mode", mode, "kp", kp, "kd", kd, "ki", ki, "set_point", set_point, "feedforward",
        feedforward, "effort_limit", effort_limit, "anti_windup", anti_windup, "side", side, "sample_time", sample_time,
        "delay", delay);
    for (const auto& [mode, kp, kd, ki, anti_windup] : servo.other_modes)
      all("mode", mode, "kp", kp, "kd", kd, "ki", ki, "anti_windup", anti_windup);
  }

  // ---- simulation
  void add(const scene::InitialJoint& initial) {
    const auto& [coordinate, position, velocity, location, gives_velocity] = initial;
    all("coordinate", coordinate, "position", position, "velocity", velocity, "gives_velocity", gives_velocity);
  }
  void add(const scene::InitialLink& initial) {
    all("link", initial.link, "linear", initial.linear, "angular", initial.angular);
  }
  void add(const scene::PointLoad& load) {
    const auto& [link, at, force, moment, frame, history, location] = load;
    all("link", link, "at", at, "force", force, "moment", moment, "frame", frame, "history", history);
  }
  void add(const scene::DistributedLoad& load) {
    all("link", load.link, "force", load.force, "frame", load.frame, "history", load.history);
    if (load.from || load.to) all("from", load.from, "to", load.to);
  }
  void add(const scene::PrescribedMotion& motion) { all("coordinate", motion.coordinate, "position", motion.position); }
  void add(const scene::Sensor& sensor) {
    const auto& [name, kind, link, joint, group, at, rate, noise, bias, seed, location, tendon] = sensor;
    all("name", name, "kind", kind, "link", link, "at", at, "rate", rate, "noise", noise, "bias", bias, "seed", seed);
    if (!joint.empty()) all("joint", joint);
    if (!group.empty()) all("group", group);
    if (!tendon.empty()) all("tendon", tendon);
  }
  void add(const std::shared_ptr<const scene::ForceElementDescription>& element) {
    const std::vector<scene::LinkPoint> points = element->points();
    for (const scene::LinkPoint& point : points) all("link", point.link);
    for (const scene::LinkPoint& point : points) all("at", point.at);
    for (const double number : element->numbers()) all("number", number);
    for (const TimeFunction& function : element->functions()) all("function", function);
  }
  void add(const scene::GroundDescription& ground) {
    all("name", ground.name, "normal", ground.normal, "offset", ground.offset);
  }
  void add(const scene::ContactPair& pair) { all("first", pair.first, "second", pair.second); }
  void add(const scene::RestitutionDescription& restitution) {
    const auto& [values, speeds] = restitution;
    if (speeds.empty())
      add(values.front());
    else
      all("values", values, "speeds", speeds);
  }
  void add(const scene::ContactDescription& contact) {
    all("first", contact.first, "second", contact.second, "stiffness", contact.stiffness, "restitution",
        contact.restitution, "friction", contact.friction, "spinning", contact.spinning, "rolling", contact.rolling);
    add_given("contact_time", contact.contact_time);
    if (contact.grip != scene::ContactDescription().grip) all("grip", contact.grip);
  }
  void add(const scene::SurfaceHints& hints) { all("friction", hints.friction, "stiffness", hints.stiffness); }
  void add(const scene::ClearanceDescription& clearance) {
    const auto& [joint, closes_loop, radius, length, width, journal, stiffness, contact_time, restitution, friction,
                 location] = clearance;
    all("joint", joint, "closes_loop", closes_loop, "radius", radius, "length", length, "width", width, "journal",
        journal, "stiffness", stiffness, "restitution", restitution, "friction", friction);
    add_given("contact_time", contact_time);
  }
  void add(const scene::BoxShape& box) { all("size", box.size); }
  void add(const scene::CylinderShape& cylinder) {
    all("radius", cylinder.radius, "length", cylinder.length);
    if (cylinder.inner_radius > 0) all("inner_radius", cylinder.inner_radius);
  }
  void add(const scene::SphereShape& sphere) { all("radius", sphere.radius); }
  void add(const scene::MeshShape& mesh) { all("url", mesh.url, "scale", mesh.scale); }
  void add(const scene::VisualDescription& shape) { all("origin", shape.origin, "shape", shape.shape); }
  void add(const scene::JointEffort& effort) { all("coordinate", effort.coordinate, "history", effort.history); }

  std::string path_;
  std::vector<SceneValue>& values_;
  Fingerprint bytes_;
};

/// The lines that must agree, and the values from which they are made.
class Identity {
 public:
  template <class... NamesAndParts>
  void line(const std::string& kind, const NamesAndParts&... parts) {
    SceneParts seen(kind, out_.values);
    seen.all(parts...);
    out_.text += kind + " " + seen.fingerprint() + "\n";
  }
  /// A line for one part. The values of its members need no further name.
  template <class Part>
  void part(const std::string& kind, const Part& part) {
    SceneParts seen(kind, out_.values);
    seen.add_part(part);
    out_.text += kind + " " + seen.fingerprint() + "\n";
  }
  template <class Parts>
  void each(const char* kind, const Parts& parts) {
    for (const auto& one : parts) part(fmt::format("{} '{}'", kind, one.name), one);
  }

  void integrator(double step, const Scheme& scheme) {
    const NumericalDissipation& d = scheme.dissipation;
    out_.text += fmt::format(
        "scheme {}, step {} s, beta {}, gamma {}, alpha {}, dissipation {} {} {}, interpolation {}, weak form {}\n",
        scheme.name, step, scheme.beta, scheme.gamma, scheme.alpha, d.stiffness, d.forgetting, d.inertance,
        static_cast<int>(scheme.interpolation), static_cast<int>(scheme.weak_form));
    const auto tell = [&](const char* name, const auto& value) {
      out_.values.push_back({name, fmt::format("{}", value)});
    };
    tell("scheme", scheme.name);
    tell("step", step);
    tell("beta", scheme.beta);
    tell("gamma", scheme.gamma);
    tell("alpha", scheme.alpha);
    tell("dissipation", fmt::format("{} {} {}", d.stiffness, d.forgetting, d.inertance));
    tell("interpolation", static_cast<int>(scheme.interpolation));
    tell("weak_form", static_cast<int>(scheme.weak_form));
  }

  /// One line for each kind of force element that the scene has.
  void force_elements(const scene::ForceElementDescriptions& elements) {
    std::map<std::string, scene::ForceElementDescriptions> kinds;
    for (const auto& element : elements) kinds[element->kind()].push_back(element);
    for (const auto& [kind, list] : kinds) part(kind + "s", list);
  }

  /// One line if the scene has contacts.
  void contacts(const scene::SceneDescription& scene) {
    if (scene.contacts.empty()) return;
    std::vector<std::vector<scene::VisualDescription>> shapes;
    for (const scene::LinkDescription& link : scene.links) shapes.push_back(link.collisions);
    std::vector<std::string> names;
    std::vector<scene::SurfaceHints> surfaces;
    for (const auto& [link, hints] : scene.surfaces) names.push_back(link), surfaces.push_back(hints);
    line("contact", "grounds", scene.grounds, "pairs", scene.contacts, "no_contact", scene.no_contacts, "shapes",
         shapes, "surfaces of", names, "surfaces", surfaces);
  }

  /// Parameters have no lines in the text, since the numbers that are computed from them count. But they explain best
  /// why these differ.
  void parameters(const std::vector<scene::ParameterDescription>& parameters) {
    for (const scene::ParameterDescription& parameter : parameters)
      out_.values.push_back({"parameter '" + parameter.name + "'", fmt::format("{}", parameter.value)});
  }

  void text(const char* line) { out_.text += line; }
  SceneIdentity take() { return std::move(out_); }

 private:
  SceneIdentity out_;
};

}  // namespace

SceneIdentity identity_of(const scene::SceneDescription& scene, const Scheme& scheme) {
  const auto& [name, file, root, links, joints, loop_joints, cylinders, springs, drives, servos, gravity, contact_time,
               integrator, integrator_location, initial_joints, initial_links, loads, distributed_loads, motions,
               efforts, probes, sensors, force_elements, grounds, contacts, no_contacts, surfaces, clearances,
               lock_massless, starts_in_equilibrium, equilibrium_location, parameters] = scene;
  Identity identity;
  identity.parameters(parameters);
  identity.integrator(integrator.step, scheme);
  identity.each("link", links);
  identity.each("joint", joints);
  identity.each("loop_joint", loop_joints);
  if (!cylinders.empty()) identity.part("cylinder", cylinders);
  identity.part("spring", springs);
  identity.part("drive", drives);
  identity.part("servo", servos);
  identity.part("gravity", gravity);
  if (contact_time != scene::SceneDescription().contact_time) identity.part("contact_time", contact_time);
  identity.line("initial", "root", root, "joint", initial_joints, "link", initial_links, "lock_massless",
                lock_massless);
  identity.part("load", loads);
  identity.part("distributed_load", distributed_loads);
  identity.part("motion", motions);
  identity.part("effort", efforts);
  if (starts_in_equilibrium) identity.text("initial equilibrium\n");
  identity.each("sensor", sensors);
  identity.force_elements(force_elements);
  identity.contacts(scene);
  if (!clearances.empty()) identity.part("clearance", clearances);
  return identity.take();
}

std::string scene_identity(const scene::SceneDescription& scene) {
  return identity_of(scene, make_scheme(scene.integrator)).text;
}

}  // namespace flexarm
