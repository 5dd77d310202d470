#include "simulation/linear_ports.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/element_matrices.h"
#include "flexarm/scene/scene_description.h"
#include "math/so3.h"
#include "simulation/beam_sections.h"
#include "simulation/inside.h"
#include "simulation/observables.h"

namespace flexarm {

// ---------------------------------------------------------------- how sensors of sections change as nodes move

namespace {

/// Derivatives of a scalar with respect to {displacement, spin} of a few nodes, world axes.
struct NodalGradient {
  std::vector<int> nodes;
  Eigen::RowVectorXd row;
  /// Rate of the scalar. `velocities`: {v, w} of all nodes, world axes.
  double along(const std::vector<Vector6>& velocities) const;
};

double NodalGradient::along(const std::vector<Vector6>& velocities) const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += row.segment<6>(6 * static_cast<Eigen::Index>(i)).dot(velocities[nodes[i]]);
  return sum;
}

struct SectionVariation {
  std::vector<int> nodes;
  Eigen::MatrixXd strain, resultant;  // derivatives by the nodes' motion; about the mass centroid
};

SectionVariation section_variation(const Model& model, const State& state, const ProbePoint& point) {
  SectionVariation out;
  visit_element(model, *model.links[point.link].beam, point.element, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    out.nodes.assign(element.nodes.begin(), element.nodes.end());
    out.strain = out.resultant = Eigen::MatrixXd::Zero(6, 6 * N);
    const std::array<double, N - 1> weights = extension_weights<N>(point.xi);
    const std::vector<Eigen::MatrixXd> variations = strain_variations(element, state);
    for (int k = 0; k < N - 1; ++k) {
      out.strain += weights[k] * variations[k];
      out.resultant += weights[k] * element.stiffness_points[k].stiffness.lazyProduct(variations[k]);
    }
  });
  return out;
}

/// Gradient of fibre_strain(), with local interpolation.
NodalGradient fibre_strain_gradient(const Model& model, const State& state, const ProbePoint& point) {
  const SectionVariation section = section_variation(model, state, point);
  // The sensor is at d from the mass centroid, which adds K x d to the strain.
  const Vector3 beside = point.offset.position;
  return {section.nodes, section.strain.row(0) - so3::hat(beside).row(0) * section.strain.bottomRows<3>()};
}

/// Gradient of a component of the resultant of section_point() at the point, with local interpolation.
NodalGradient section_force_gradient(const Model& model, const State& state, const ProbePoint& point, int component) {
  const SectionVariation section = section_variation(model, state, point);
  const Vector3 centroid = model.links[point.link].beam->centroid;
  Eigen::RowVectorXd row = section.resultant.row(component);
  if (component >= 3) row += so3::hat(centroid).row(component - 3) * section.resultant.topRows<3>();
  return {section.nodes, row};
}

}  // namespace

// ---------------------------------------------------------------- ports

namespace {

using Kind = LinearPort::Kind;
using Components = std::array<const char*, 6>;

constexpr Components kPlaces = {"x", "y", "z", "rx", "ry", "rz"}, kWrench = {"fx", "fy", "fz", "mx", "my", "mz"};

struct NamedPoint {
  std::string name;
  ProbePoint point;
};

/// Points at which inputs and outputs may be: links that can move, ends of beams, and probes.
std::vector<NamedPoint> points_of(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  std::vector<NamedPoint> points;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const LinkFrame& link = model.links[i];
    ProbePoint point;
    point.link = static_cast<int>(i);
    point.attachment = link.frame;
    if (link.frame.node >= 0) points.push_back({link.name, point});
    if (!link.beam) continue;
    point.attachment = link.beam->tip;
    points.push_back({link.name + "/tip", point});
  }
  const auto& probes = simulation.scene().probes;
  for (std::size_t i = 0; i < probes.size(); ++i) points.push_back({probes[i].name, model.probes[i]});
  return points;
}

/// The kind of sensors that measure an output of this kind, if it is measured by sensors.
std::optional<scene::SensorKind> sensor_kind(Kind kind) {
  if (kind == Kind::Strain) return scene::SensorKind::Strain;
  if (kind == Kind::SectionForce) return scene::SensorKind::SectionForce;
  return std::nullopt;
}

std::vector<NamedPoint> sensors_of(const Simulation& simulation, scene::SensorKind kind) {
  std::vector<NamedPoint> sensors;
  for (std::size_t i = 0; i < simulation.scene().sensors.size(); ++i)
    if (const scene::Sensor& sensor = simulation.scene().sensors[i]; sensor.kind == kind)
      sensors.push_back({sensor.name, model_of(simulation).sensors[i].point});
  return sensors;
}

/// Points at which a port of this kind may be.
std::vector<NamedPoint> points_of(const Simulation& simulation, Kind kind) {
  if (const auto sensors = sensor_kind(kind)) return sensors_of(simulation, *sensors);
  return kind == Kind::Effort || kind == Kind::Motion ? std::vector<NamedPoint>() : points_of(simulation);
}

/// Names of the components of a port at a point. A strain has a single one, without a name.
std::vector<std::string> components_of(Kind kind) {
  if (kind == Kind::Strain) return {""};
  const Components& names = kind == Kind::Wrench || kind == Kind::SectionForce ? kWrench : kPlaces;
  return {names.begin(), names.end()};
}

bool is_driven(const Simulation& simulation, std::size_t coordinate) {
  return model_of(simulation).coordinates[coordinate].motion >= 0;
}

bool is_of_coordinates(Kind kind) {
  return kind != Kind::Wrench && !sensor_kind(kind);
}

/// Lists the names that may follow the colon of this kind, for error messages.
std::string existing(const Simulation& simulation, Kind kind) {
  std::vector<std::string> names;
  const auto& coordinates = simulation.coordinate_names();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const bool fits = kind == Kind::Effort   ? simulation.is_commandable(i)
                      : kind == Kind::Motion ? is_driven(simulation, i)
                                             : is_of_coordinates(kind);
    if (fits) names.push_back(coordinates[i]);
  }
  for (const NamedPoint& point : points_of(simulation, kind)) names.push_back(point.name);
  return names.empty() ? "there is none" : fmt::format("there are {}", fmt::join(names, ", "));
}

class PortReader {
 public:
  PortReader(const Simulation& simulation, bool is_input) : simulation_(simulation), is_input_(is_input) {}

  void read(const std::string& text, std::vector<LinearPort>& ports) const {
    const std::size_t colon = text.find(':');
    const std::optional<Kind> kind = kind_of(text.substr(0, colon));
    if (!kind || colon == std::string::npos)
      throw std::invalid_argument(
          fmt::format("'{}' is not an {}: expected {}", text, is_input_ ? "input" : "output",
                      is_input_ ? "effort:JOINT, motion:JOINT or wrench:POINT:fx"
                                : "position:, velocity: or acceleration: and a joint or a point, effort:JOINT, "
                                  "strain:SENSOR or section_force:SENSOR"));
    const std::string name = text.substr(colon + 1);
    if (add_coordinate(*kind, name, text, ports) || add_point(*kind, name, text, ports)) return;
    throw std::invalid_argument(fmt::format("'{}' does not exist: for '{}:' {}", text, text.substr(0, colon),
                                            existing(simulation_, driven_effort(*kind) ? Kind::Motion : *kind)));
  }

 private:
  bool driven_effort(Kind kind) const { return kind == Kind::Effort && !is_input_; }

  std::optional<Kind> kind_of(const std::string& word) const {
    if (word == "effort") return Kind::Effort;
    if (is_input_ && word == "motion") return Kind::Motion;
    if (is_input_ && word == "wrench") return Kind::Wrench;
    if (!is_input_ && word == "position") return Kind::Position;
    if (!is_input_ && word == "velocity") return Kind::Velocity;
    if (!is_input_ && word == "acceleration") return Kind::Acceleration;
    if (!is_input_ && word == "strain") return Kind::Strain;
    if (!is_input_ && word == "section_force") return Kind::SectionForce;
    return std::nullopt;
  }

  bool add_coordinate(Kind kind, const std::string& name, const std::string& text,
                      std::vector<LinearPort>& ports) const {
    const std::optional<std::size_t> index = simulation_.find_coordinate(name);
    if (!index || !is_of_coordinates(kind)) return false;
    if (kind == Kind::Effort && is_input_ && !simulation_.is_commandable(*index)) return false;
    if ((kind == Kind::Motion || driven_effort(kind)) && !is_driven(simulation_, *index)) return false;
    LinearPort port;
    port.kind = kind;
    port.coordinate = static_cast<int>(*index);
    port.name = text;
    ports.push_back(port);
    return true;
  }

  bool add_point(Kind kind, const std::string& name, const std::string& text, std::vector<LinearPort>& ports) const {
    const std::vector<std::string> components = components_of(kind);
    for (const NamedPoint& candidate : points_of(simulation_, kind)) {
      const bool is_whole = name == candidate.name;
      bool is_found = false;
      for (std::size_t k = 0; k < components.size(); ++k) {
        const std::string suffix = components[k].empty() ? "" : ":" + components[k];
        if (!is_whole && name != candidate.name + suffix) continue;
        LinearPort port;
        port.kind = kind;
        port.point = candidate.point;
        port.component = static_cast<int>(k);
        port.name = is_whole ? text + suffix : text;
        ports.push_back(port);
        is_found = true;
      }
      if (is_found) return true;
    }
    return false;
  }

  const Simulation& simulation_;
  bool is_input_;
};

std::vector<LinearPort> read(const Simulation& simulation, bool is_input, const std::vector<std::string>& names) {
  const PortReader reader(simulation, is_input);
  std::vector<LinearPort> ports;
  for (const std::string& name : names) reader.read(name, ports);
  return ports;
}

/// Rate of a port's quantity, from the rates of all scalars and {v, w} of the nodes, world axes.
using PortRate = std::function<double(const Eigen::VectorXd& scalars, const std::vector<Vector6>& velocities)>;

/// `state` must outlive the returned function.
PortRate rate_of(const LinearPort& port, const Model& model, const DegreesOfFreedom& dof, const State& state) {
  if (port.coordinate >= 0)
    return [scalar = dof.scalar_of(model.coordinates[port.coordinate])](const Eigen::VectorXd& scalars, const auto&) {
      return scalars[scalar];
    };
  if (sensor_kind(port.kind))
    return [gradient = port.kind == Kind::Strain ? fibre_strain_gradient(model, state, port.point)
                                                 : section_force_gradient(model, state, port.point, port.component)](
               const Eigen::VectorXd&, const auto& velocities) { return gradient.along(velocities); };
  return [&](const Eigen::VectorXd&, const std::vector<Vector6>& velocities) {
    const ProbeState probe = probe_state(model, state, velocities, port.point);
    return port.component < 3 ? probe.velocity[port.component] : probe.angular_velocity[port.component - 3];
  };
}

}  // namespace

std::vector<LinearPort> input_ports(const Simulation& simulation, const std::vector<std::string>& names) {
  if (!names.empty()) return read(simulation, true, names);
  std::vector<std::string> efforts;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    if (simulation.is_commandable(i)) efforts.push_back("effort:" + simulation.coordinate_names()[i]);
  return read(simulation, true, efforts);
}

std::vector<LinearPort> output_ports(const Simulation& simulation, const std::vector<std::string>& names) {
  if (!names.empty()) return read(simulation, false, names);
  std::vector<std::string> positions;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    if (!is_driven(simulation, i)) positions.push_back("position:" + simulation.coordinate_names()[i]);
  std::vector<LinearPort> ports = read(simulation, false, positions);
  // Not read by name, since a joint or a link may have the same name.
  const auto& probes = simulation.scene().probes;
  for (std::size_t i = 0; i < probes.size(); ++i)
    for (int k = 0; k < 6; ++k) {
      LinearPort port;
      port.kind = Kind::Position;
      port.point = model_of(simulation).probes[i];
      port.component = k;
      port.name = fmt::format("position:{}:{}", probes[i].name, kPlaces[k]);
      ports.push_back(port);
    }
  return ports;
}

MovingMatrix port_motion(const Simulation& simulation, const LinearDynamics& dynamics,
                         const std::vector<LinearPort>& ports) {
  const Model& model = model_of(simulation);
  const DegreesOfFreedom& dof = dynamics.degrees_of_freedom();
  MovingMatrix motion =
      dynamics.along_reference([&](const MechanismPose& pose, const Eigen::MatrixXd& rows) -> Eigen::MatrixXd {
        const State state = state_at(pose);
        std::vector<PortRate> rates;
        rates.reserve(ports.size());
        for (const LinearPort& port : ports) rates.push_back(rate_of(port, model, dof, state));
        Eigen::MatrixXd out(static_cast<Eigen::Index>(ports.size()), rows.cols());
        std::vector<Vector6> velocities(pose.nodes.size());
        for (Eigen::Index column = 0; column < rows.cols(); ++column) {
          for (std::size_t n = 0; n < velocities.size(); ++n) {
            velocities[n] = rows.col(column).segment<6>(dof.first[n]);
            velocities[n].tail<3>() = (pose.nodes[n].rotation * velocities[n].tail<3>()).eval();
          }
          for (std::size_t i = 0; i < ports.size(); ++i)
            out(static_cast<Eigen::Index>(i), column) = rates[i](rows.col(column), velocities);
        }
        return out;
      });
  for (Eigen::MatrixXd* matrix : {&motion.value, &motion.first, &motion.second}) {
    const Eigen::Index own = matrix->cols();
    matrix->conservativeResize(Eigen::NoChange, dynamics.size());
    matrix->rightCols(dynamics.size() - own).setZero();
  }
  // A motor with an elastic gear acts on its rotor.
  for (std::size_t i = 0; i < ports.size(); ++i)
    for (std::size_t r = 0; r < dynamics.rotors().size() && ports[i].kind == Kind::Effort; ++r) {
      if (model.actuators[dynamics.rotors()[r]].coordinate != ports[i].coordinate) continue;
      motion.value.row(static_cast<Eigen::Index>(i)).setZero();
      motion.value(static_cast<Eigen::Index>(i), dynamics.size() - static_cast<int>(dynamics.rotors().size() - r)) = 1;
    }
  return motion;
}

}  // namespace flexarm
