#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "flexarm/simulation/linear_reduction.h"
#include "flexarm/simulation/linear_response.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "simulation/step_resolution.h"

namespace py = pybind11;

namespace flexarm::python {
namespace {

/// Stacks matrices to an array with the shape (matrices, outputs, inputs).
template <class Number, class Matrix>
py::array_t<Number> stacked(const std::vector<Matrix>& matrices, const LinearModel& model) {
  py::array_t<Number> array({matrices.size(), model.outputs.size(), model.inputs.size()});
  Number* place = array.mutable_data();
  for (const Matrix& matrix : matrices)
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) *place++ = matrix(i, j);
  return array;
}

LinearModel linearise(GuardedSimulation& guarded, const std::vector<std::string>& inputs,
                      const std::vector<std::string>& outputs, const std::string& about) {
  LinearRequest request{LinearisedAbout::Rest, inputs, outputs};
  if (about == "steady")
    request.about = LinearisedAbout::Steady;
  else if (about == "instant")
    request.about = LinearisedAbout::Instant;
  else if (about != "rest")
    throw std::invalid_argument("about: expected 'rest', 'steady' or 'instant', got '" + about + "'");
  std::string doubt;
  LinearModel model = guarded.work([&](const Simulation& simulation) {
    LinearModel about_now = flexarm::linearise(simulation, request);
    if (request.about == LinearisedAbout::Instant) doubt = doubt_about_instant(simulation, about_now);
    return about_now;
  });
  if (!doubt.empty()) warn(doubt);
  return model;
}

std::vector<std::complex<double>> poles_of(const LinearModel& model) {
  std::vector<std::complex<double>> values;
  for (const Pole& pole : poles(model)) values.push_back(pole.value);
  return values;
}

py::tuple reduced_model(const LinearModel& model, int order) {
  ReducedModel reduced = [&] {
    const py::gil_scoped_release unlocked;
    return flexarm::reduced(model, order);
  }();
  return py::make_tuple(std::move(reduced.model), reduced.hankel_singular_values);
}

py::tuple step_response_of(const LinearModel& model, double until, int intervals) {
  const StepResponse response = step_response(model, until, intervals);
  return py::make_tuple(py::array_t<double>(static_cast<py::ssize_t>(response.times.size()), response.times.data()),
                        stacked<double>(response.outputs, model));
}

}  // namespace

void bind_linear_models(py::module_& module, SimulationClass& simulation) {
  using Class = py::class_<LinearModel>;
  Class type(module, "LinearModel", R"(Small deviations from a reference motion: x' = a x + b u, v = c x + d u.

The states x are positions, followed by their rates. The model is derived from mass y'' + damping y' + stiffness y =
forces, with y the `coordinates`, including those that <motion>s drive. docs/linearise.md)");
  type.attr("__module__") = "flexarm";
  const auto matrix = [&](const char* name, Eigen::MatrixXd LinearModel::*member, const char* text) {
    type.def_property_readonly(
        name, [member](const LinearModel& model) { return model.*member; }, text);
  };
  const auto names = [&](const char* name, std::vector<std::string> LinearModel::*member, const char* text) {
    type.def_property_readonly(
        name, [member](const LinearModel& model) { return model.*member; }, text);
  };
  matrix("a", &LinearModel::a, "Derivatives of the states' rates by the states, shape (states, states).");
  matrix("b", &LinearModel::b, "Derivatives of the states' rates by the inputs, shape (states, inputs).");
  matrix("c", &LinearModel::c, "Derivatives of the outputs by the states, shape (outputs, states).");
  matrix("d", &LinearModel::d, "Derivatives of the outputs by the inputs, shape (outputs, inputs).");
  matrix("mass", &LinearModel::mass, "Mass matrix, shape (coordinates, coordinates).");
  matrix("damping", &LinearModel::damping, "Damping matrix, with gyroscopic terms, shape (coordinates, coordinates).");
  matrix("stiffness", &LinearModel::stiffness,
         "Stiffness matrix, with centrifugal terms, shape (coordinates, coordinates).");
  names("states", &LinearModel::states, "Names of the states.");
  names("inputs", &LinearModel::inputs, "Names of the inputs.");
  names("outputs", &LinearModel::outputs, "Names of the outputs.");
  names("coordinates", &LinearModel::coordinates, "Names of the coordinates y.");
  names("left_out", &LinearModel::left_out, "Descriptions of effects of the scene that the model leaves out.");
  type.def_property_readonly(
          "drift", [](const LinearModel& model) { return model.drift; },
          "x' on the reference motion, shape (states,); zero for a reference at rest.")
      .def(
          "poles",
          [](const LinearModel& model) {
            const std::vector<std::complex<double>> values = poles_of(model);
            return py::array_t<std::complex<double>>(static_cast<py::ssize_t>(values.size()), values.data());
          },
          "Eigenvalues of a, sorted by magnitude; of conjugate pairs only those with an imaginary part >= 0 [1/s].")
      .def(
          "frequency_response",
          [](const LinearModel& model, const std::vector<double>& frequencies) {
            return stacked<std::complex<double>>(frequency_response(model, frequencies).gains, model);
          },
          R"(Complex gains c (2 pi i f - a)^-1 b + d, shape (frequencies, outputs, inputs).

frequencies: f [Hz]. Raises RuntimeError at the frequency of an undamped pole.)",
          py::arg("frequencies"))
      .def("step_response", &step_response_of, R"(Responses to a step of one input from 0 to 1 at t = 0, for each input.

until: the last time [s]. intervals: number of equal intervals between the times.
Returns times, shape (intervals + 1,), and outputs, shape (intervals + 1, outputs, inputs).)",
           py::arg("until"), py::arg("intervals") = 1000)
      .def("reduced", &reduced_model, R"(A model with `order` states, by balanced truncation of its decaying part.

Poles that do not decay are kept if inputs move them and outputs show it. The error of every gain is at most twice the
sum of the Hankel singular values that are left out. Returns the LinearModel and all Hankel singular values, the largest
first. Raises ValueError if there is no model of that `order`.)",
           py::arg("order"));
  simulation.def("linearise", &linearise, R"(A LinearModel of small motions about the present configuration.

inputs: names as "effort:JOINT", "motion:JOINT", "wrench:POINT:fx"; none: efforts on all effort_joints.
outputs: as "position:JOINT", "acceleration:POINT:x", "strain:SENSOR"; none: positions of joints and probes.
about: 'rest': the present configuration without velocities, under the loads at t = 0 (call solve_static() before);
  'steady': a steady motion with the velocities of <motion>s at t = 0; 'instant': the present motion.

Raises ValueError, which lists the existing names, if an input or output does not exist; RuntimeError if there is no
such model.)",
                 py::arg("inputs") = std::vector<std::string>(), py::arg("outputs") = std::vector<std::string>(),
                 py::kw_only(), py::arg("about") = "rest");
}

}  // namespace flexarm::python
