#include "model/degrees_of_freedom.h"

namespace flexarm {

DegreesOfFreedom::DegreesOfFreedom(const Model& model)
    : node_count(static_cast<int>(model.nodes.size())),
      joint_count(static_cast<int>(model.joints.size_with_held())),
      slave_joint(model.nodes.size(), -1) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) slave_joint[model.joints[j].slave] = static_cast<int>(j);

  for (int i = 0; i < node_count; ++i) size.push_back(6);
  for (int j = 0; j < joint_count; ++j) size.push_back(released_count(model.joints[j].kind));
  for (const LoopClosure& closure : model.closures) size.push_back(static_cast<int>(closure.constraints.size()));
  for (const int n : size) {
    first.push_back(scalar_count);
    scalar_count += n;
  }

  std::vector<bool> dependent(scalar_count, false);
  for (int i = 0; i < node_count; ++i)
    if (slave_joint[i] >= 0)
      for (int k = 0; k < 6; ++k) dependent[first[i] + k] = true;
  for (std::size_t index = 0; index < model.coordinates.size(); ++index) {
    const Coordinate& coordinate = model.coordinates[index];
    const int variable = variable_of_joint(coordinate.joint);
    if (coordinate.motion >= 0 || coordinate.mimicked >= 0 || is_held(model, coordinate))
      dependent[scalar_of(coordinate)] = true;
    if (coordinate.mimicked >= 0)
      mimics.push_back(
          {variable, variable_of_joint(model.coordinates[coordinate.mimicked].joint), static_cast<int>(index)});
  }

  equation.assign(scalar_count, -1);
  for (int scalar = 0; scalar < scalar_count; ++scalar) {
    if (dependent[scalar]) continue;
    if (scalar == 0 || dependent[scalar - 1]) runs.push_back({scalar, unknowns, 0});
    ++runs.back().count;
    equation[scalar] = unknowns++;
  }
}

int DegreesOfFreedom::add_variable(int count) {
  size.push_back(count);
  first.push_back(scalar_count);
  scalar_count += count;
  equation.resize(scalar_count, -1);
  return static_cast<int>(size.size()) - 1;
}

}  // namespace flexarm
