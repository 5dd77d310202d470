#include "cli/linear_table.h"

#include "cli/json_text.h"
#include "simulation/csv_fields.h"

namespace flexarm::cli {
namespace {

std::string json_matrix(const Eigen::MatrixXd& matrix) {
  std::string rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows += (i > 0 ? ",\n  " : "") + json_array(matrix.row(i));
  return "[" + rows + "]";
}

std::string json_names(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + json_string(name);
  return "[" + list + "]";
}

void append_rows(std::string& table, const std::vector<std::string>& names, const Eigen::MatrixXd& by_states,
                 const Eigen::MatrixXd& by_inputs) {
  for (Eigen::Index i = 0; i < by_states.rows(); ++i) {
    std::string line;
    csv::append(line, names[static_cast<std::size_t>(i)]);
    for (const Eigen::MatrixXd* matrix : {&by_states, &by_inputs})
      for (Eigen::Index j = 0; j < matrix->cols(); ++j) csv::append(line, (*matrix)(i, j));
    table += line + "\n";
  }
}

}  // namespace

std::string linear_model_as_json(const std::string& scene, const LinearModel& model) {
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
  append_member(members, "coordinates", json_names(model.coordinates));
  append_member(members, "mass", json_matrix(model.mass));
  append_member(members, "damping", json_matrix(model.damping));
  append_member(members, "stiffness", json_matrix(model.stiffness));
  append_member(members, "residual", json_array(model.residual));
  return "{" + members + "}\n";
}

std::string linear_model_as_csv(const LinearModel& model) {
  std::string header;
  csv::append(header, "row");
  for (const auto* names : {&model.states, &model.inputs})
    for (const std::string& name : *names) csv::append(header, name);
  std::string table = header + "\n";
  append_rows(table, model.states, model.a, model.b);
  append_rows(table, model.outputs, model.c, model.d);
  return table;
}

}  // namespace flexarm::cli
