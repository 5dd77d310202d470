#include <limits>
#include <stdexcept>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/names.h"
#include "simulation/inside.h"

namespace py = pybind11;

namespace flexarm::python {

namespace {

OnFailure on_failure_of(const std::string& name) {
  if (const std::optional<OnFailure> on_failure = on_failure_called(name)) return *on_failure;
  throw std::invalid_argument("on_failure: expected 'stop' or 'dissipate', got '" + name + "'");
}

/// A Scene, or that of a path.
std::shared_ptr<ReadScene> scene_of(const py::object& given) {
  if (py::isinstance<ReadScene>(given)) return given.cast<std::shared_ptr<ReadScene>>();
  if (!py::isinstance<py::str>(given) && !py::hasattr(given, "__fspath__"))
    throw py::type_error(std::string("scene: expected a Scene, or the path of a scene's file, got ") +
                         Py_TYPE(given.ptr())->tp_name);
  return py::module_::import("flexarm._flexarm").attr("read_scene")(given).cast<std::shared_ptr<ReadScene>>();
}

std::shared_ptr<GuardedSimulation> simulation_of(const py::object& given, const std::optional<std::string>& scheme,
                                                 std::optional<double> step, std::optional<double> tolerance,
                                                 bool reuse_factorisation, const std::optional<std::string>& on_failure,
                                                 double recovery_wall_time) {
  SimulationOptions options{scheme, step, tolerance, reuse_factorisation, std::nullopt, recovery_wall_time};
  if (on_failure) options.on_failure = on_failure_of(*on_failure);
  const std::shared_ptr<ReadScene> scene = scene_of(given);
  try {
    const auto made = [&] {
      const py::gil_scoped_release unlocked;
      return std::make_shared<GuardedSimulation>(scene, Simulation(*scene, options));
    }();
    for (const scene::Diagnostic& warning : made->use().start_warnings()) warn(warning.text());
    return made;
  } catch (const ModelError& error) {
    raise_scene_error(error.what());
  }
}

/// A property that is a function of the simulation.
template <class Look>
void look(SimulationClass& type, const char* name, const Look& look, const char* text) {
  type.def_property_readonly(
      name, [look](GuardedSimulation& simulation) { return look(simulation.use()); }, text);
}

void bind_names(SimulationClass& type) {
  look(
      type, "joint_names", [](const Simulation& s) { return s.coordinate_names(); },
      "of released coordinates, in the order of all arrays of joints");
  look(type, "effort_joints", &effort_joints, "names of those that take commands of efforts");
  look(
      type, "effort_limits",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) {
          const double limit = model_of(s).coordinates[i].effort_limit;
          return limit > 0 ? limit : std::numeric_limits<double>::infinity();
        });
      },
      "of joints, at which commanded efforts saturate, shape (joints,); infinite where there is none [N m or N]");
  look(type, "servo_joints", &servo_joints, "names of those with servos");
  look(
      type, "link_names", [](const Simulation& s) { return s.link_names(); }, "in the order of all arrays of links");
  look(
      type, "flexible_links",
      [](const Simulation& s) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < s.link_names().size(); ++i)
          if (s.is_flexible(i)) names.push_back(s.link_names()[i]);
        return names;
      },
      "names of those with beams that bend");
  look(type, "probe_names", &probe_names, "in the order of all arrays of probes");
  look(type, "sensor_names", &sensor_names, "in the scene's order");
}

void bind_joints(SimulationClass& type) {
  look(
      type, "positions",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.position(i); });
      },
      "of joints, shape (joints,) [rad or m]");
  look(
      type, "velocities",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.velocity(i); });
      },
      "of joints, shape (joints,), of second order and without what rings in the scheme's own [rad/s or m/s]");
  look(
      type, "efforts",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.effort(i); });
      },
      "of joints, shape (joints,): applied in the last step; where a motion is prescribed, what drives it [N m or N]");
}

void bind_sums(SimulationClass& type) {
  look(
      type, "energies",
      [](const Simulation& s) {
        const Energies e = s.energies();
        return make("flexarm.values", "Energies", e.kinetic, e.strain, e.potential, e.total(), e.work, e.dissipated);
      },
      "Energies: kinetic, strain, potential, total, and since the start work and dissipated [J]");
  look(
      type, "momentum", [](const Simulation& s) { return numbers(3, [m = s.momentum()](int i) { return m[i]; }); },
      "shape (3,) [kg m/s]");
  look(
      type, "angular_momentum",
      [](const Simulation& s) { return numbers(3, [m = s.angular_momentum()](int i) { return m[i]; }); },
      "about the world's origin, shape (3,) [kg m^2/s]");
  look(
      type, "mass", [](const Simulation& s) { return s.mass(); }, "of all that moves [kg]");
}

py::list contacts(const Simulation& simulation) {
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  const auto array = [](const Vector3& vector) { return numbers(3, [&](int i) { return vector[i]; }); };
  py::list out;
  for (const ActingContact& contact : contacts)
    out.append(make("flexarm.values", "Contact", contact.first, contact.second, array(contact.position),
                    array(contact.normal), array(contact.force), contact.penetration));
  return out;
}

void bind_contacts(SimulationClass& type) {
  look(type, "contacts", &contacts,
       "where links touch each other and grounds now: a list of Contact, one for each point: first, second, position, "
       "normal, force, penetration");
}

void bind_settings(SimulationClass& type) {
  type.def_property_readonly(
      "scene", [](const GuardedSimulation& s) { return s.scene(); }, "the Scene of which it was made");
  look(
      type, "time", [](const Simulation& s) { return s.time(); }, "[s]");
  look(
      type, "scheme", [](const Simulation& s) { return s.scheme(); }, "of time integration, the one in use");
  look(
      type, "node_count", [](const Simulation& s) { return s.node_count(); }, "nodes of the model");
  look(
      type, "degrees_of_freedom", [](const Simulation& s) { return s.degrees_of_freedom(); },
      "unknowns of Newton's method");
  type.def_property(
      "step_size", [](GuardedSimulation& s) { return s.use().step_size(); },
      [](GuardedSimulation& s, double step) { s.use().set_step_size(step); },
      "length of steps from the next one on [s]; ValueError if it does not divide the sample time of a servo");
  type.def_property(
      "tolerance", [](GuardedSimulation& s) { return s.use().tolerance(); },
      [](GuardedSimulation& s, double tolerance) { s.use().set_tolerance(tolerance); },
      "of Newton's method: of its last update, relative to the scene's length and to 1 rad");
}

}  // namespace

void bind_looks(SimulationClass& type) {
  type.def(py::init(&simulation_of), R"(Builds a simulation of a scene.

scene: a Scene, or the path of its file, which is read as read_scene(path) does.
scheme, step [s], tolerance: in place of the scene's.
reuse_factorisation: keeps factors of the tangent while Newton's method contracts well; False: a restored state goes on
  bit for bit.
on_failure: 'stop' or 'dissipate' (steps that fail are done by edmc2), in place of the scene's.
recovery_wall_time: ends a step that has been halved after so long by the clock on the wall; 0: never [s].

Raises SceneError if the file has errors or the scene is impossible as a mechanism; what is doubtful about its start is a SceneWarning.)",
           py::arg("scene"), py::arg("scheme") = py::none(), py::arg("step") = py::none(),
           py::arg("tolerance") = py::none(), py::arg("reuse_factorisation") = true, py::arg("on_failure") = py::none(),
           py::arg("recovery_wall_time") = 0.0);
  bind_settings(type);
  bind_names(type);
  bind_joints(type);
  bind_sums(type);
  bind_contacts(type);
  type.def("__repr__", [](GuardedSimulation& guarded) {
    const Simulation& s = guarded.use();
    return fmt::format("<flexarm.Simulation of '{}' at t = {:g} s: {} joints, {} unknowns, {} in steps of {:g} s>",
                       s.scene().name, s.time(), s.coordinate_names().size(), s.degrees_of_freedom(), s.scheme(),
                       s.step_size());
  });
}

}  // namespace flexarm::python
