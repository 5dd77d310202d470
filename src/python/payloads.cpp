#include "flexarm/simulation/payloads.h"

#include <array>

#include <pybind11/stl.h>

#include "python/bindings.h"
#include "python/errors.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

using Three = std::array<double, 3>;

Vector3 vector_of(const Three& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Edits the scene. A ModelError of the new scene becomes a SceneError.
template <class Edit>
void edit_scene(GuardedSimulation& guarded, const Edit& edit) {
  try {
    guarded.edit(edit);
  } catch (const ModelError& error) {
    raise_scene_error(error.what());
  }
}

void spawn_model(GuardedSimulation& guarded, const ReadScene& model, const Three& position,
                 const std::array<double, 4>& orientation, const Three& linear, const Three& angular,
                 const std::string& prefix) {
  const Quaternion turn(orientation[3], orientation[0], orientation[1], orientation[2]);
  const Spawn where{{vector_of(position), turn}, vector_of(linear), vector_of(angular), prefix};
  edit_scene(guarded, [&](Simulation& simulation) { spawn(simulation, model, where); });
}

}  // namespace

void bind_payloads(SimulationClass& type) {
  type.def(
          "attach",
          [](GuardedSimulation& guarded, const std::string& link, const std::string& to) {
            edit_scene(guarded, [&](Simulation& simulation) { attach(simulation, link, to); });
          },
          R"(Fixes a link that floats, with all that it carries, to another link, where it is.

Momenta are conserved; the energy lost by the impact counts as dissipated. Afterwards joints, links, probes and sensors
may have other indices, and earlier States cannot be restored; the same holds for detach(), spawn() and remove(). Raises
ValueError, and changes nothing, if it is impossible.)",
          py::arg("link"), py::arg("to"))
      .def(
          "detach",
          [](GuardedSimulation& guarded, const std::string& link) {
            edit_scene(guarded, [&](Simulation& simulation) { detach(simulation, link); });
          },
          "Removes the fixed joint that carries a link, which then moves freely with its present velocity.",
          py::arg("link"))
      .def("spawn", &spawn_model,
           R"(Adds the links and joints of another Scene, its root link floating at a pose, with a velocity.

model: a Scene, from read_scene(path, to_spawn=True).
orientation: quaternion x y z w. linear, angular: velocities of the root link's origin, world axes [m/s, rad/s]. prefix:
put before the names of its links, joints, sensors and probes.)",
           py::arg("model"), py::arg("position") = Three{0, 0, 0},
           py::arg("orientation") = std::array<double, 4>{0, 0, 0, 1}, py::arg("linear") = Three{0, 0, 0},
           py::arg("angular") = Three{0, 0, 0}, py::arg("prefix") = "")
      .def(
          "remove",
          [](GuardedSimulation& guarded, const std::string& link) {
            edit_scene(guarded, [&](Simulation& simulation) { remove(simulation, link); });
          },
          "Removes a link and all that it carries.", py::arg("link"));
}

}  // namespace flexarm::python
