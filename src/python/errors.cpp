#include "python/errors.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

constexpr const char* kErrors = "flexarm.errors";

}  // namespace

void raise(const py::object& error) {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
  throw py::error_already_set();
}

void raise_scene_error(const std::string& text) {
  raise(make(kErrors, "SceneError", text));
}

void raise_step_error(const Simulation& simulation, const std::string& text, StepResult::Reason reason,
                      const py::object& rows) {
  raise(make(kErrors, "StepError", text, simulation.time(), to_string(reason), rows));
}

void warn(const std::string& text) {
  const py::object category = py::module_::import(kErrors).attr("SceneWarning");
  if (PyErr_WarnEx(category.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace flexarm::python
