#include <fmt/format.h>

#include "python/bindings.h"

namespace py = pybind11;

namespace flexarm::python {

void bind_step_result(py::module_& module) {
  py::class_<StepResult> result(module, "StepResult", "Statistics of a step.");
  result.attr("__module__") = "flexarm";
  result.def_readonly("iterations", &StepResult::iterations, "iterations of Newton's method in all sub-steps")
      .def_readonly("factorisations", &StepResult::factorisations, "factorisations of the tangent")
      .def_readonly("halvings", &StepResult::halvings, "number of halvings of sub-steps")
      .def_readonly("deepest_halving", &StepResult::deepest_halving,
                    "the shortest sub-step was 2^-deepest_halving of the step")
      .def_readonly("other_guesses", &StepResult::other_guesses,
                    "number of sub-steps that were solved from another initial guess")
      .def_readonly("is_dissipated", &StepResult::is_dissipated, "the step was done by edmc2 (on_failure='dissipate')")
      .def_readonly("largest_rotation", &StepResult::largest_rotation,
                    "largest rotation of a node in a sub-step, 2 tan(angle/2)")
      .def("__repr__", [](const StepResult& r) {
        return fmt::format("<flexarm.StepResult: {} iterations, {} halvings>", r.iterations, r.halvings);
      });
}

}  // namespace flexarm::python
