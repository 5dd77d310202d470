#include "python/effort_rows.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/simulation/command_refusal.h"

namespace flexarm::python {
namespace {

std::vector<std::size_t> commanded_joints(const Simulation& simulation, const std::optional<std::vector<Key>>& joints) {
  std::vector<std::size_t> indices;
  if (joints) {
    for (const Key& joint : *joints) indices.push_back(joint_index(simulation, joint));
  } else {
    for (const std::string& joint : effort_joints(simulation)) indices.push_back(joint_index(simulation, joint));
  }
  for (const std::size_t joint : indices)
    if (!simulation.is_commandable(joint))
      throw std::invalid_argument(fmt::format("joints: expected joints that take efforts, of [{}], but {}",
                                              fmt::join(effort_joints(simulation), ", "),
                                              refusal_of_commands(simulation, joint)));
  return indices;
}

}  // namespace

EffortRows::EffortRows(const Simulation& simulation, const std::optional<Array>& efforts,
                       const std::optional<std::vector<Key>>& joints, long steps, std::size_t batch) {
  if (!efforts) return;
  joints_ = commanded_joints(simulation, joints);
  using Shape = std::vector<pybind11::ssize_t>;
  const auto columns = static_cast<pybind11::ssize_t>(joints_.size()), size = static_cast<pybind11::ssize_t>(batch);
  const Shape given(efforts->shape(), efforts->shape() + efforts->ndim()),
      row = {columns}, of_steps = batch > 0 ? Shape{size, steps, columns} : Shape{steps, columns},
      of_batch = batch > 0 ? Shape{size, columns} : row;
  if (given != row && given != of_steps && given != of_batch) {
    std::vector<std::string> names;
    for (const std::size_t joint : joints_) names.push_back(simulation.coordinate_names()[joint]);
    throw std::invalid_argument(fmt::format("efforts: expected the shape ({}){} or ({},), of the joints [{}], got {}",
                                            fmt::join(of_steps, ", "),
                                            batch > 0 ? fmt::format(", ({})", fmt::join(of_batch, ", ")) : "", columns,
                                            fmt::join(names, ", "), shape_text(*efforts)));
  }
  efforts_ = efforts->data();
  if (given == of_steps)
    stride_ = columns, batch_stride_ = batch > 0 ? steps * columns : 0;
  else if (given == of_batch)
    batch_stride_ = batch > 0 ? columns : 0;
  for (pybind11::ssize_t i = 0; i < efforts->size(); ++i)
    if (!std::isfinite(efforts_[i]))
      throw std::invalid_argument(
          fmt::format("efforts: expected finite numbers, got {} in row {} for joint '{}'", efforts_[i], i / columns,
                      simulation.coordinate_names()[joints_[static_cast<std::size_t>(i % columns)]]));
}

}  // namespace flexarm::python
