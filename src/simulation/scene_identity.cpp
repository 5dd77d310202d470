#include "simulation/scene_identity.h"

#include <map>
#include <memory>
#include <type_traits>

#include <fmt/format.h>

#include "schemes/scheme.h"
#include "simulation/fingerprint.h"

namespace flexarm {
namespace {

/// Fingerprint of the parts of a scene. Structures are taken apart by name, so that a new member does not compile here
/// before somebody has decided whether it counts.
class SceneFingerprint {
 public:
  template <class... Parts>
  static std::string of(const Parts&... parts) {
    SceneFingerprint fingerprint;
    fingerprint.all(parts...);
    return fingerprint.bytes_.text();
  }

 private:
  template <class... Parts>
  void all(const Parts&... parts) {
    (add(parts), ...);
  }

  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>, int> = 0>
  void add(Number number) {
    const double value = static_cast<double>(number) + 0.0;  // -0 and 0 are the same
    bytes_.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void add(const std::string& text) {
    add(text.size());
    bytes_.add(text);
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) add(matrix(i, j));
  }
  template <class Value>
  void add(const std::optional<Value>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }
  template <class... Values>
  void add(const std::variant<Values...>& value) {
    add(value.index());
    std::visit([&](const auto& held) { add(held); }, value);
  }
  void add(const TimeFunction& function) { add(function.text()); }
  void add(const Pose& pose) { all(pose.position, pose.orientation.coeffs()); }

  // ---- beams
  void add(const scene::Circle& circle) { add(circle.radius); }
  void add(const scene::Tube& tube) { all(tube.outer_radius, tube.inner_radius); }
  void add(const scene::Rectangle& rectangle) { all(rectangle.width, rectangle.height); }
  void add(const scene::BoxTube& box) { all(box.width, box.height, box.thickness); }
  void add(const scene::GeometricSection& section) {
    const auto& [young, poisson, density] = section.material;
    all(section.shape, young, poisson, density);
  }
  void add(const scene::DirectSection& section) {
    const auto& [ea, ga2, ga3, gj, ei2, ei3, mass, j1, j2, j3] = section;
    all(ea, ga2, ga3, gj, ei2, ei3, mass, j1, j2, j3);
  }
  void add(const scene::MatrixSection& section) { all(section.stiffness, section.inertia); }
  void add(const scene::SectionStations& stations) { all(stations.arc_lengths, stations.sections); }
  void add(const scene::CentrelinePiece& piece) {
    const auto& [kind, to, center, twist, location] = piece;
    all(kind, to, center, twist);
  }
  void add(const scene::HubDescription& hub) { all(hub.end, hub.mass, hub.inertia); }
  void add(const scene::BeamDescription& beam) {
    const auto& [elements, order, centreline, section_y, section, stiffness_damping, damping_shares, mass_damping,
                 prestrain, hubs, location] = beam;
    all(elements, order, centreline, section_y, section, stiffness_damping, mass_damping, hubs);
    if (damping_shares != Vector6::Ones()) add(damping_shares);
    for (std::size_t i = 0; i < prestrain.size(); ++i)
      if (prestrain[i]) all(i, *prestrain[i]);
  }

  // ---- links and joints
  void add(const scene::RigidInertia& inertia) { all(inertia.mass, inertia.center_of_mass, inertia.inertia); }
  void add(const scene::LinkDescription& link) {
    const auto& [name, inertial, beam, visuals, collisions, location] = link;
    all(name, inertial, beam);
  }
  /// What was not there before counts where it is given: other scenes keep their fingerprints.
  void add_given(const std::optional<double>& value) {
    if (value) add(*value);
  }
  void add(const scene::JointLimits& limits) {
    all(limits.lower, limits.upper);
    add_given(limits.restitution);
  }
  void add(const scene::Mimic& mimic) { all(mimic.joint, mimic.multiplier, mimic.offset); }
  void add(const scene::SlideDescription& slide) {
    const auto& [start, rotation, on_end, scheme, smooth, offset, restitution, location] = slide;
    all(start, rotation, on_end, scheme, smooth, offset);
    add_given(restitution);
  }
  void add(const scene::FrictionDescription& friction) { all(friction.law, friction.coefficient, friction.radius); }
  void add(const scene::JointDescription& joint) {
    const auto& [name, kind, parent, child, origin, axis, axis2, ratio, offset, direction, profile, slide, limits,
                 effort_limit, damping, friction, friction_law, mimic, child_origin, location] = joint;
    all(name, kind, parent, child, origin, axis, axis2, ratio, offset, direction, slide, limits, effort_limit, damping,
        friction, friction_law, mimic, child_origin);
    if (profile) add(profile->numbers());
  }

  void add(const scene::SpringDescription& spring) {
    all(spring.coordinate, spring.stiffness, spring.rest);
    if (spring.damping_ratio > 0) add(spring.damping_ratio);
  }
  void add(const scene::DriveDescription& drive) {
    const auto& [coordinate, gear, rotor_inertia, stiffness, damping, damping_ratio, backlash, friction, efficiency,
                 effort_limit, velocity_limit, axis, location] = drive;
    all(coordinate, gear, rotor_inertia, stiffness, damping, backlash, friction, efficiency, effort_limit,
        velocity_limit, axis);
    if (damping_ratio > 0) add(damping_ratio);
  }
  void add(const scene::ServoDescription& servo) {
    const auto& [coordinate, mode, kp, kd, ki, set_point, feedforward, effort_limit, anti_windup, side, sample_time,
                 delay, other_modes, location] = servo;
    all(coordinate, mode, kp, kd, ki, set_point, feedforward, effort_limit, anti_windup, side, sample_time, delay);
    for (const auto& [mode, kp, kd, ki, anti_windup] : servo.other_modes) all(mode, kp, kd, ki, anti_windup);
  }

  // ---- simulation
  void add(const scene::InitialJoint& initial) {
    const auto& [coordinate, position, velocity, location, gives_velocity] = initial;
    all(coordinate, position, velocity, gives_velocity);
  }
  void add(const scene::InitialLink& initial) { all(initial.link, initial.linear, initial.angular); }
  void add(const scene::PointLoad& load) {
    const auto& [link, at, force, moment, frame, history, location] = load;
    all(link, at, force, moment, frame, history);
  }
  void add(const scene::DistributedLoad& load) {
    all(load.link, load.force, load.frame, load.history);
    if (load.from || load.to) all(load.from, load.to);
  }
  void add(const scene::PrescribedMotion& motion) { all(motion.coordinate, motion.position); }
  void add(const scene::Sensor& sensor) {
    const auto& [name, kind, link, joint, group, at, rate, noise, bias, seed, location] = sensor;
    all(name, kind, link, at, rate, noise, bias, seed);
    if (!joint.empty()) all(joint);
    if (!group.empty()) all(group);
  }
  void add(const std::shared_ptr<const scene::ForceElementDescription>& element) {
    const std::vector<scene::LinkPoint> points = element->points();
    for (const scene::LinkPoint& point : points) add(point.link);
    for (const scene::LinkPoint& point : points) add(point.at);
    for (const double number : element->numbers()) add(number);
  }
  void add(const scene::GroundDescription& ground) { all(ground.name, ground.normal, ground.offset); }
  void add(const scene::ContactPair& pair) { all(pair.first, pair.second); }
  void add(const scene::ContactDescription& contact) {
    all(contact.first, contact.second, contact.stiffness, contact.restitution, contact.friction, contact.spinning,
        contact.rolling);
  }
  void add(const scene::SurfaceHints& hints) { all(hints.friction, hints.stiffness); }
  void add(const scene::ClearanceDescription& clearance) {
    const auto& [joint, closes_loop, radius, length, width, journal, stiffness, restitution, friction, location] =
        clearance;
    all(joint, closes_loop, radius, length, width, journal, stiffness, restitution, friction);
  }
  void add(const scene::BoxShape& box) { add(box.size); }
  void add(const scene::CylinderShape& cylinder) { all(cylinder.radius, cylinder.length); }
  void add(const scene::SphereShape& sphere) { add(sphere.radius); }
  void add(const scene::MeshShape& mesh) { all(mesh.url, mesh.scale); }
  void add(const scene::VisualDescription& shape) { all(shape.origin, shape.shape); }
  void add(const scene::JointEffort& effort) { all(effort.coordinate, effort.history); }

  Fingerprint bytes_;
};

std::string integrator_line(double step, const Scheme& scheme) {
  const NumericalDissipation& d = scheme.dissipation;
  return fmt::format(
      "scheme {}, step {} s, beta {}, gamma {}, alpha {}, dissipation {} {} {}, interpolation {}, weak form {}",
      scheme.name, step, scheme.beta, scheme.gamma, scheme.alpha, d.stiffness, d.forgetting, d.inertance,
      static_cast<int>(scheme.interpolation), static_cast<int>(scheme.weak_form));
}

template <class Parts>
std::string named_lines(const char* kind, const Parts& parts) {
  std::string text;
  for (const auto& part : parts) text += fmt::format("{} '{}' {}\n", kind, part.name, SceneFingerprint::of(part));
  return text;
}

/// One for each kind that there is.
std::string force_element_lines(const scene::ForceElementDescriptions& elements) {
  std::map<std::string, scene::ForceElementDescriptions> kinds;
  for (const auto& element : elements) kinds[element->kind()].push_back(element);
  std::string text;
  for (const auto& [kind, list] : kinds) text += fmt::format("{}s {}\n", kind, SceneFingerprint::of(list));
  return text;
}

/// One where something may touch.
std::string contact_lines(const scene::SceneDescription& scene) {
  if (scene.contacts.empty()) return "";
  std::vector<std::vector<scene::VisualDescription>> shapes;
  for (const scene::LinkDescription& link : scene.links) shapes.push_back(link.collisions);
  std::vector<std::string> names;
  std::vector<scene::SurfaceHints> surfaces;
  for (const auto& [link, hints] : scene.surfaces) names.push_back(link), surfaces.push_back(hints);
  return fmt::format("contact {}\n",
                     SceneFingerprint::of(scene.grounds, scene.contacts, scene.no_contacts, shapes, names, surfaces));
}

}  // namespace

std::string scene_identity(const scene::SceneDescription& scene, const Scheme& scheme) {
  const auto& [name, file, root, links, joints, loop_joints, springs, drives, servos, gravity, integrator,
               integrator_location, initial_joints, initial_links, loads, distributed_loads, motions, efforts, probes,
               sensors, force_elements, grounds, contacts, no_contacts, surfaces, clearances, lock_massless,
               starts_in_equilibrium, equilibrium_location,
               parameters] = scene;  // which count by the numbers that are made of them
  return integrator_line(integrator.step, scheme) + "\n" + named_lines("link", links) + named_lines("joint", joints) +
         named_lines("loop_joint", loop_joints) +
         fmt::format("spring {}\ndrive {}\nservo {}\n", SceneFingerprint::of(springs), SceneFingerprint::of(drives),
                     SceneFingerprint::of(servos)) +
         fmt::format("gravity {}\ninitial {}\nload {}\ndistributed_load {}\nmotion {}\neffort {}\n",
                     SceneFingerprint::of(gravity),
                     SceneFingerprint::of(root, initial_joints, initial_links, lock_massless),
                     SceneFingerprint::of(loads), SceneFingerprint::of(distributed_loads),
                     SceneFingerprint::of(motions), SceneFingerprint::of(efforts)) +
         (starts_in_equilibrium ? "initial equilibrium\n" : "") + named_lines("sensor", sensors) +
         force_element_lines(force_elements) + contact_lines(scene) +
         (clearances.empty() ? "" : fmt::format("clearance {}\n", SceneFingerprint::of(clearances)));
}

std::string scene_identity(const scene::SceneDescription& scene) {
  return scene_identity(scene, make_scheme(scene.integrator));
}

}  // namespace flexarm
