#include "recording/mat_writer.h"

#include <array>
#include <memory>
#include <vector>

#include <matio.h>

#include "recording/replaced_file.h"

namespace flexarm::recording {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

/// Removes const for Mat_VarCreate(), which copies the data and does not change them.
template <class T>
T* copied(const T* data) {
  return const_cast<T*>(data);
}

Variable numbers(const char* name, const Eigen::MatrixXd& matrix) {
  std::array<size_t, 2> size = {static_cast<size_t>(matrix.rows()), static_cast<size_t>(matrix.cols())};
  return {Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), copied(matrix.data()), 0), &Mat_VarFree};
}

Variable text(const char* name, const std::string& value) {
  std::array<size_t, 2> size = {1, value.size()};
  return {Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), copied(value.data()), 0), &Mat_VarFree};
}

/// A column of cells, one per string.
Variable cells(const char* name, const std::vector<std::string>& values) {
  std::array<size_t, 2> size = {values.size(), 1};
  std::vector<matvar_t*> entries;  // the cell array takes ownership
  for (const std::string& value : values) entries.push_back(text(nullptr, value).release());
  return {Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), entries.data(), 0), &Mat_VarFree};
}

Variable numbers(const char* name, const std::vector<double>& column) {
  return numbers(name, Eigen::Map<const Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size())));
}

/// A three-dimensional array, with one matrix per frequency.
Variable gains(const std::vector<Eigen::MatrixXcd>& matrices) {
  std::vector<double> real, imaginary;
  for (const Eigen::MatrixXcd& matrix : matrices)
    for (Eigen::Index k = 0; k < matrix.size(); ++k) {
      real.push_back(matrix.data()[k].real());
      imaginary.push_back(matrix.data()[k].imag());
    }
  std::array<size_t, 3> size = {static_cast<size_t>(matrices.front().rows()),
                                static_cast<size_t>(matrices.front().cols()), matrices.size()};
  mat_complex_split_t parts = {real.data(), imaginary.data()};
  return {Mat_VarCreate("gains", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, size.data(), &parts, MAT_F_COMPLEX), &Mat_VarFree};
}

/// A three-dimensional array as MATLAB's step() returns it: the first index is that of time.
Variable step_outputs(const std::vector<Eigen::MatrixXd>& matrices) {
  std::array<size_t, 3> size = {matrices.size(), static_cast<size_t>(matrices.front().rows()),
                                static_cast<size_t>(matrices.front().cols())};
  std::vector<double> values;
  for (Eigen::Index k = 0; k < matrices.front().size(); ++k)
    for (const Eigen::MatrixXd& matrix : matrices) values.push_back(matrix.data()[k]);
  return {Mat_VarCreate("step_response", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, size.data(), values.data(), 0), &Mat_VarFree};
}

template <class Member>
std::vector<Member> of_events(const std::vector<RunEvent>& events, Member RunEvent::*member) {
  std::vector<Member> values;
  for (const RunEvent& event : events) values.push_back(event.*member);
  return values;
}

}  // namespace

void write_mat(const std::string& path, const std::string& scene, const LinearModel& model,
               const LinearResponses& responses) {
  ReplacedFile place(path);
  std::unique_ptr<mat_t, decltype(&Mat_Close)> file(
      Mat_CreateVer(place.unfinished().c_str(), "MATLAB 5.0 MAT-file, written by flexarm", MAT_FT_MAT5), &Mat_Close);
  if (!file) place.fail("cannot be created");
  const auto write = [&](const Variable& variable) {
    if (!variable || Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_NONE) != 0)
      place.fail("cannot be written");
  };
  write(text("scene", scene));
  write(numbers("A", model.a));
  write(numbers("B", model.b));
  write(numbers("C", model.c));
  write(numbers("D", model.d));
  write(numbers("drift", model.drift));
  write(numbers("mass", model.mass));
  write(numbers("damping", model.damping));
  write(numbers("stiffness", model.stiffness));
  write(numbers("residual", model.residual));
  write(cells("states", model.states));
  write(cells("inputs", model.inputs));
  write(cells("outputs", model.outputs));
  write(cells("coordinates", model.coordinates));
  write(cells("left_out", model.left_out));
  if (!responses.frequency.frequencies.empty()) {
    write(numbers("frequencies", responses.frequency.frequencies));
    write(gains(responses.frequency.gains));
  }
  if (!responses.step.times.empty()) {
    write(numbers("times", responses.step.times));
    write(step_outputs(responses.step.outputs));
  }
  const RunDerivatives& run = responses.derivatives;
  if (!run.parameters.empty()) {
    write(cells("parameters", run.parameters));
    write(numbers("states_by_parameters", run.states));
    write(numbers("outputs_by_parameters", run.outputs));
  }
  if (!run.initial_states.empty()) {
    write(cells("initial_states", run.initial_states));
    write(numbers("transition", run.transition));
  }
  if (!run.parameters.empty() || !run.initial_states.empty()) {
    write(numbers("event_times", of_events(run.events, &RunEvent::time)));
    write(cells("event_joints", of_events(run.events, &RunEvent::joint)));
    write(cells("event_kinds", of_events(run.events, &RunEvent::what)));
    write(cells("event_doubts", of_events(run.events, &RunEvent::doubt)));
  }
  if (Mat_Close(file.release()) != 0) place.fail("cannot be written");
  place.put_in_place();
}

}  // namespace flexarm::recording
