#include "cli/linear_table.h"

#include "math/json_text.h"
#include "math/pi.h"
#include "simulation/csv_fields.h"

namespace flexarm::cli {
namespace {

std::string json_matrix(const Eigen::MatrixXd& matrix) {
  std::string rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows += (i > 0 ? ",\n  " : "") + json_array(matrix.row(i));
  return "[" + rows + "]";
}

std::string json_complex(const std::complex<double>& number) {
  return "[" + json_number(number.real()) + ", " + json_number(number.imag()) + "]";
}

/// A JSON list of `text(entry)` for each entry.
template <class List, class Text>
std::string json_list(const List& entries, const char* separator, const Text& text) {
  std::string list;
  for (const auto& entry : entries) list += (list.empty() ? "" : separator) + text(entry);
  return "[" + list + "]";
}

std::string json_event(const RunEvent& event) {
  std::string members;
  append_member(members, "time", json_number(event.time));
  append_member(members, "joint", json_string(event.joint));
  append_member(members, "what", json_string(event.what));
  append_member(members, "doubt", json_string(event.doubt));
  return "{" + members + "}";
}

/// A list of matrices, one for each frequency.
std::string json_gains(const std::vector<Eigen::MatrixXcd>& gains) {
  return json_list(gains, ",\n  ", [](const Eigen::MatrixXcd& matrix) {
    std::vector<std::string> rows;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const Eigen::VectorXcd row = matrix.row(i);
      rows.push_back(
          json_list(std::vector<std::complex<double>>(row.data(), row.data() + row.size()), ", ", json_complex));
    }
    return json_list(rows, ", ", [](const std::string& row) { return row; });
  });
}

std::string json_names(const std::vector<std::string>& names) {
  return json_list(names, ", ", json_string);
}

/// Appends "kind OUTPUT / INPUT" for each pair and kind; the kind varies fastest, then the input.
void append_pairs(std::string& header, const LinearModel& model, const std::vector<std::string>& kinds) {
  for (const std::string& output : model.outputs)
    for (const std::string& input : model.inputs)
      for (const std::string& kind : kinds) csv::append(header, kind + output + " / " + input);
}

/// Appends a row for each name that contains this row of all matrices, side by side.
void append_rows(std::string& table, const std::vector<std::string>& names,
                 const std::vector<const Eigen::MatrixXd*>& matrices) {
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(names.size()); ++i) {
    std::string line;
    csv::append(line, names[static_cast<std::size_t>(i)]);
    for (const Eigen::MatrixXd* matrix : matrices)
      for (Eigen::Index j = 0; j < matrix->cols(); ++j) csv::append(line, (*matrix)(i, j));
    table += line + "\n";
  }
}

}  // namespace

std::string linear_model_as_json(const std::string& scene, const LinearModel& model, const LinearResponses& responses) {
  std::string members;
  append_member(members, "scene", json_string(scene));
  append_member(members, "states", json_names(model.states));
  append_member(members, "inputs", json_names(model.inputs));
  append_member(members, "outputs", json_names(model.outputs));
  append_member(members, "left_out", json_names(model.left_out));
  append_member(members, "A", json_matrix(model.a));
  append_member(members, "B", json_matrix(model.b));
  append_member(members, "C", json_matrix(model.c));
  append_member(members, "D", json_matrix(model.d));
  append_member(members, "drift", json_array(model.drift));
  append_member(members, "poles",
                json_list(poles(model), ", ", [](const Pole& pole) { return json_complex(pole.value); }));
  append_member(members, "coordinates", json_names(model.coordinates));
  append_member(members, "mass", json_matrix(model.mass));
  append_member(members, "damping", json_matrix(model.damping));
  append_member(members, "stiffness", json_matrix(model.stiffness));
  append_member(members, "residual", json_array(model.residual));
  if (const auto& [frequencies, gains] = responses.frequency; !frequencies.empty()) {
    append_member(members, "frequencies", json_list(frequencies, ", ", json_number));
    append_member(members, "gains", json_gains(gains));
  }
  if (const auto& [times, outputs] = responses.step; !times.empty()) {
    append_member(members, "times", json_list(times, ", ", json_number));
    append_member(members, "step_response", json_list(outputs, ",\n  ", json_matrix));
  }
  if (const RunDerivatives& run = responses.derivatives; !run.parameters.empty()) {
    append_member(members, "parameters", json_names(run.parameters));
    append_member(members, "states_by_parameters", json_matrix(run.states));
    append_member(members, "outputs_by_parameters", json_matrix(run.outputs));
  }
  if (const RunDerivatives& run = responses.derivatives; !run.initial_states.empty()) {
    append_member(members, "initial_states", json_names(run.initial_states));
    append_member(members, "transition", json_matrix(run.transition));
  }
  if (const RunDerivatives& run = responses.derivatives; !run.parameters.empty() || !run.initial_states.empty())
    append_member(members, "events", json_list(run.events, ",\n  ", json_event));
  return "{" + members + "}\n";
}

std::string linear_model_as_csv(const LinearModel& model, const RunDerivatives& run) {
  std::string header;
  csv::append(header, "row");
  for (const auto* names : {&model.states, &model.inputs})
    for (const std::string& name : *names) csv::append(header, name);
  for (const std::string& name : run.parameters) csv::append(header, "parameter " + name);
  std::string table = header + "\n";
  append_rows(table, model.states, {&model.a, &model.b, &run.states});
  append_rows(table, model.outputs, {&model.c, &model.d, &run.outputs});
  return table;
}

std::string frequency_response_as_csv(const LinearModel& model, const FrequencyResponse& response) {
  std::string table = "frequency";
  append_pairs(table, model, {"gain ", "phase "});
  table += "\n";
  for (std::size_t n = 0; n < response.frequencies.size(); ++n) {
    std::string line;
    csv::append(line, response.frequencies[n]);
    const Eigen::MatrixXcd& gains = response.gains[n];
    for (Eigen::Index i = 0; i < gains.rows(); ++i)
      for (Eigen::Index j = 0; j < gains.cols(); ++j) {
        csv::append(line, std::abs(gains(i, j)));
        csv::append(line, std::arg(gains(i, j)) * 180 / kPi);
      }
    table += line + "\n";
  }
  return table;
}

std::string step_response_as_csv(const LinearModel& model, const StepResponse& response) {
  std::string table = "time";
  append_pairs(table, model, {""});
  table += "\n";
  for (std::size_t n = 0; n < response.times.size(); ++n) {
    std::string line;
    csv::append(line, response.times[n]);
    const Eigen::MatrixXd& outputs = response.outputs[n];
    for (Eigen::Index i = 0; i < outputs.rows(); ++i)
      for (Eigen::Index j = 0; j < outputs.cols(); ++j) csv::append(line, outputs(i, j));
    table += line + "\n";
  }
  return table;
}

}  // namespace flexarm::cli
