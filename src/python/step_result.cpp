#include <fmt/format.h>

#include "python/bindings.h"

namespace py = pybind11;

namespace flexarm::python {

void bind_step_result(py::module_& module) {
  py::class_<StepResult> result(module, "StepResult", "What it took to do a step.");
  result.attr("__module__") = "flexarm";
  result.def_readonly("iterations", &StepResult::iterations, "of Newton's method, of all sub-steps")
      .def_readonly("factorisations", &StepResult::factorisations, "of the tangent")
      .def_readonly("halvings", &StepResult::halvings, "times that a sub-step had to be halved")
      .def_readonly("deepest_halving", &StepResult::deepest_halving,
                    "the shortest sub-step was 2^-deepest_halving of the step")
      .def_readonly("other_guesses", &StepResult::other_guesses,
                    "sub-steps that were solved from another guess than the first")
      .def_readonly("is_dissipated", &StepResult::is_dissipated, "it was done by edmc2 (on_failure='dissipate')")
      .def_readonly("largest_rotation", &StepResult::largest_rotation, "of a node in a sub-step, 2 tan(angle/2)")
      .def("__repr__", [](const StepResult& r) {
        return fmt::format("<flexarm.StepResult: {} iterations, {} halvings>", r.iterations, r.halvings);
      });
}

}  // namespace flexarm::python
