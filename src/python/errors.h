#pragma once
/// Raises exceptions and warnings that src/python/flexarm/errors.py defines.

#include <string>

#include <pybind11/pybind11.h>

#include "flexarm/simulation/simulation.h"
#include "python/older_pybind11.h"

namespace flexarm::python {

/// Makes an object of a class in a module of the package, such as an exception.
template <class... Arguments>
pybind11::object make(const char* module, const char* name, Arguments&&... arguments) {
  return pybind11::module_::import(module).attr(name)(std::forward<Arguments>(arguments)...);
}

[[noreturn]] void raise(const pybind11::object& error);
[[noreturn]] void raise_scene_error(const std::string& text);
/// @param rows  the rows that were recorded before the failure, or None
[[noreturn]] void raise_step_error(const Simulation& simulation, const std::string& text, StepResult::Reason reason,
                                   const pybind11::object& rows = pybind11::none());
/// Warns with SceneWarning, at the line of Python code that called.
void warn(const std::string& text);

}  // namespace flexarm::python
