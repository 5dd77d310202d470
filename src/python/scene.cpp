#include <filesystem>

#include <pybind11/stl.h>

#include <fmt/format.h>

#include "flexarm/scene/urdf_reader.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/names.h"
#include "python/path_argument.h"
#include "python/read_scene.h"
#include "simulation/scene_identity.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

using scene::ParameterValues;
using ScenePointer = std::shared_ptr<ReadScene>;

constexpr const char* kReadScene = R"(Reads a URDF file with flexarm's extension elements (docs/scene_format.md).

path: path of the file.
parameters: values for parameters of the scene by name, which replace those of the file, {"payload": 200}.
clamp_start: joints that would start outside their limits start at the nearest limit (start="clamp").
equilibrium_start: everything starts at rest in the equilibrium of loads, gravity and servos (start="equilibrium").
lock_massless: joints that move nothing with inertia are held where they start (massless="lock").
xacro_args: arguments for xacro, "NAME=VALUE NAME=VALUE", which expands a file *.xacro if it is installed.
to_spawn: it is for Simulation.spawn(), where its root link floats: there is no warning that this link is clamped.

Raises SceneError whose text has one line for each error of the file; doubtful contents give a SceneWarning.)";

constexpr const char* kReadSceneText = R"(Reads the text of a scene. Messages have `name` in the place of a file's name.

Options and errors are those of read_scene(), without xacro_args.)";

/// Reads a scene with `read` and given options, and keeps `read` so that the scene can be read again with others.
/// Findings become warnings. Errors become an exception with the text that the command line prints.
ScenePointer scene_of(const scene::ReadOptions& options,
                      const std::function<scene::ReadResult(const scene::ReadOptions&)>& read) {
  scene::ReadResult result = read(options);
  if (result.scene) {
    for (const scene::Diagnostic& warning : result.diagnostics) warn(warning.text());
    const SceneReader again = [options, read](const std::string& parameter, double value) {
      scene::ReadOptions others = options;
      others.parameters[parameter] = value;
      return read(others);
    };
    return std::make_shared<ReadScene>(std::move(*result.scene), again);
  }
  std::string findings = scene::to_text(result.diagnostics);
  if (!findings.empty()) findings.pop_back();  // the last newline
  raise_scene_error(findings);
}

ScenePointer read_scene(const PathArgument& path, const ParameterValues& parameters, bool clamp_start,
                        bool equilibrium_start, bool lock_massless, const std::string& xacro_args, bool to_spawn) {
  return scene_of({clamp_start, lock_massless, equilibrium_start, parameters, xacro_args, nullptr, to_spawn},
                  [path = std::filesystem::absolute(path.text).string()](const scene::ReadOptions& options) {
                    return scene::read_scene_file(path, options);
                  });
}

ScenePointer read_scene_text(const std::string& text, const std::string& name, const ParameterValues& parameters,
                             bool clamp_start, bool equilibrium_start, bool lock_massless, bool to_spawn) {
  return scene_of(
      {clamp_start, lock_massless, equilibrium_start, parameters, {}, nullptr, to_spawn},
      [text, name](const scene::ReadOptions& options) { return scene::read_scene_text(text, name, options); });
}

/// A list of flexarm.Parameter, in the order of the file.
py::list parameters_of(const ReadScene& scene) {
  py::list parameters;
  for (const scene::ParameterDescription& parameter : scene.parameters)
    parameters.append(
        make("flexarm.values", "Parameter", parameter.name, parameter.value, parameter.min, parameter.max));
  return parameters;
}

std::vector<std::string> beams_of(const ReadScene& scene) {
  std::vector<std::string> names;
  for (const scene::LinkDescription& link : scene.links)
    if (link.beam) names.push_back(link.name);
  return names;
}

std::string text_of(const ReadScene& scene) {
  return fmt::format(
      "<flexarm.Scene '{}' from '{}': {} links ({} with beams), {} joints, {} loop joints, {} probes, {} sensors, "
      "scheme {}, step {:g} s>",
      scene.name, scene.file, scene.links.size(), beams_of(scene).size(), scene.joints.size(), scene.loop_joints.size(),
      scene.probes.size(), scene.sensors.size(), scene.integrator.scheme, scene.integrator.step);
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<ReadScene, ScenePointer> scene(module, "Scene", R"(The contents of a scene file; immutable.

read_scene() and read_scene_text() make it.)");
  scene.attr("__module__") = "flexarm";
  scene.def_readonly("name", &ReadScene::name, "name of the robot")
      .def_readonly("file", &ReadScene::file, "file from which it was read")
      .def_property_readonly(
          "links", [](const ReadScene& s) { return names_of(s.links); }, "names of the links")
      .def_property_readonly("beams", &beams_of, "names of the links with beams")
      .def_property_readonly(
          "joints", [](const ReadScene& s) { return names_of(s.joints); },
          "names of the joints of the tree, not of their coordinates")
      .def_property_readonly(
          "probes", [](const ReadScene& s) { return names_of(s.probes); }, "names of the probes")
      .def_property_readonly(
          "sensors", [](const ReadScene& s) { return names_of(s.sensors); }, "names of the sensors")
      .def_property_readonly("parameters", &parameters_of,
                             "parameters of the scene: a list of flexarm.Parameter, with their present values")
      .def_property_readonly(
          "identity", [](const ReadScene& s) { return scene_identity(s); },
          "text that is equal for two scenes if a state of one is valid for the other (checkpoints are checked for it)")
      .def_property_readonly(
          "gravity", [](const ReadScene& s) { return std::vector<double>(s.gravity.data(), s.gravity.data() + 3); },
          "gravity, x y z [m/s^2]")
      .def_property_readonly(
          "scheme", [](const ReadScene& s) { return s.integrator.scheme; },
          "scheme of time integration, as written in the file")
      .def_property_readonly(
          "step", [](const ReadScene& s) { return s.integrator.step; }, "time step [s]")
      .def("__repr__", &text_of);

  module.def("read_scene", &read_scene, kReadScene, py::arg("path"), py::arg("parameters") = ParameterValues(),
             py::kw_only(), py::arg("clamp_start") = false, py::arg("equilibrium_start") = false,
             py::arg("lock_massless") = false, py::arg("xacro_args") = "", py::arg("to_spawn") = false);
  module.def("read_scene_text", &read_scene_text, kReadSceneText, py::arg("text"), py::arg("name") = "scene",
             py::arg("parameters") = ParameterValues(), py::kw_only(), py::arg("clamp_start") = false,
             py::arg("equilibrium_start") = false, py::arg("lock_massless") = false, py::arg("to_spawn") = false);
}

}  // namespace flexarm::python
