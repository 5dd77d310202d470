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

/// The given Scene, or the scene that is read from a given path.
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

/// Defines a property whose value is a function of the simulation.
template <class Look>
void look(SimulationClass& type, const char* name, const Look& look, const char* text) {
  type.def_property_readonly(
      name, [look](GuardedSimulation& simulation) { return look(simulation.use()); }, text);
}

void bind_names(SimulationClass& type) {
  look(
      type, "joint_names", [](const Simulation& s) { return s.coordinate_names(); },
      "names of released coordinates; all arrays of joints have this order");
  look(type, "effort_joints", &effort_joints, "names of joints to which efforts can be commanded");
  look(
      type, "effort_limits",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) {
          const double limit = model_of(s).coordinates[i].effort_limit;
          return limit > 0 ? limit : std::numeric_limits<double>::infinity();
        });
      },
      "limits of joints at which commanded efforts saturate, shape (joints,); infinite for joints without one [N m or "
      "N]");
  look(type, "servo_joints", &servo_joints, "names of joints with servos");
  look(
      type, "link_names", [](const Simulation& s) { return s.link_names(); },
      "names of links; all arrays of links have this order");
  look(
      type, "flexible_links",
      [](const Simulation& s) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < s.link_names().size(); ++i)
          if (s.is_flexible(i)) names.push_back(s.link_names()[i]);
        return names;
      },
      "names of links with flexible beams");
  look(type, "probe_names", &probe_names, "names of probes; all arrays of probes have this order");
  look(type, "sensor_names", &sensor_names, "names of sensors, in the scene's order");
}

void bind_joints(SimulationClass& type) {
  look(
      type, "positions",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.position(i); });
      },
      "positions of joints, shape (joints,) [rad or m]");
  look(
      type, "velocities",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.velocity(i); });
      },
      "velocities of joints, shape (joints,), of second order and without the numerical oscillations of the scheme's "
      "own velocities [rad/s or m/s]");
  look(
      type, "efforts",
      [](const Simulation& s) {
        return numbers(s.coordinate_names().size(), [&](std::size_t i) { return s.effort(i); });
      },
      "efforts of joints, shape (joints,): applied in the last step; for a prescribed motion the effort that it needs "
      "[N m or N]");
}

void bind_sums(SimulationClass& type) {
  look(
      type, "energies",
      [](const Simulation& s) {
        const Energies e = s.energies();
        return make("flexarm.values", "Energies", e.kinetic, e.strain, e.potential, e.total(), e.work, e.dissipated);
      },
      "Energies: kinetic, strain, potential and total; work and dissipated are totals since the start [J]");
  look(
      type, "momentum", [](const Simulation& s) { return numbers(3, [m = s.momentum()](int i) { return m[i]; }); },
      "linear momentum, shape (3,) [kg m/s]");
  look(
      type, "angular_momentum",
      [](const Simulation& s) { return numbers(3, [m = s.angular_momentum()](int i) { return m[i]; }); },
      "angular momentum about the world's origin, shape (3,) [kg m^2/s]");
  look(
      type, "mass", [](const Simulation& s) { return s.mass(); }, "mass of all moving parts [kg]");
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
       "points in which links touch each other or grounds: a list of Contact, with first, second, position, normal, "
       "force, penetration");
}

void bind_settings(SimulationClass& type) {
  type.def_property_readonly(
      "scene", [](const GuardedSimulation& s) { return s.scene(); }, "the Scene from which it was built");
  look(
      type, "time", [](const Simulation& s) { return s.time(); }, "simulated time [s]");
  look(
      type, "scheme", [](const Simulation& s) { return s.scheme(); }, "scheme of time integration in use");
  look(
      type, "node_count", [](const Simulation& s) { return s.node_count(); }, "number of nodes");
  look(
      type, "degrees_of_freedom", [](const Simulation& s) { return s.degrees_of_freedom(); },
      "number of unknowns in Newton's method");
  type.def_property(
      "step_size", [](GuardedSimulation& s) { return s.use().step_size(); },
      [](GuardedSimulation& s, double step) { s.use().set_step_size(step); },
      "length of steps from the next one on [s]; ValueError if it does not divide the sample time of a servo");
  type.def_property(
      "tolerance", [](GuardedSimulation& s) { return s.use().tolerance(); },
      [](GuardedSimulation& s, double tolerance) { s.use().set_tolerance(tolerance); },
      "tolerance of Newton's method: limit of its last update, relative to the scene's length and to 1 rad");
}

}  // namespace

void bind_looks(SimulationClass& type) {
  type.def(py::init(&simulation_of), R"(Builds a simulation of a scene.

scene: a Scene, or the path of its file, which is read as read_scene(path) does.
scheme, step [s], tolerance: replace those of the scene.
reuse_factorisation: keeps the factorised tangent while Newton's method converges fast. With False, a run from a
  restored state has the same bits as the original one.
on_failure: 'stop' or 'dissipate' (edmc2 does steps that fail), instead of the scene's.
recovery_wall_time: a step that was halved fails after this wall time [s]; 0: no limit.

Raises SceneError if the file has errors or the scene is impossible as a mechanism; warns (SceneWarning) of a doubtful
start.)",
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
