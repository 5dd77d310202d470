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

/// What the edited scene cannot be is an error of a scene.
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

Momenta stay; what the impact loses of the energy counts as dissipated. Joints, links, probes and sensors may have other
places in their lists afterwards, and States of before do not fit any more; so it is with detach(), spawn() and
remove(). Raises ValueError that says why it cannot be; nothing has changed then.)",
          py::arg("link"), py::arg("to"))
      .def(
          "detach",
          [](GuardedSimulation& guarded, const std::string& link) {
            edit_scene(guarded, [&](Simulation& simulation) { detach(simulation, link); });
          },
          "Frees a link that hangs on a fixed joint: it flies on as it moves.", py::arg("link"))
      .def("spawn", &spawn_model,
           R"(Adds the links and joints of another Scene, its root link floating at a pose, with a velocity.

orientation: quaternion x y z w. linear, angular: of the root link's origin, world axes [m/s, rad/s]. prefix: put before
the names of its links, joints, sensors and probes.)",
           py::arg("model"), py::arg("position") = Three{0, 0, 0},
           py::arg("orientation") = std::array<double, 4>{0, 0, 0, 1}, py::arg("linear") = Three{0, 0, 0},
           py::arg("angular") = Three{0, 0, 0}, py::arg("prefix") = "")
      .def(
          "remove",
          [](GuardedSimulation& guarded, const std::string& link) {
            edit_scene(guarded, [&](Simulation& simulation) { remove(simulation, link); });
          },
          "Takes a link away, with all that it carries.", py::arg("link"));
}

}  // namespace flexarm::python
