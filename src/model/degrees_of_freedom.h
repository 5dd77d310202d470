#pragma once
/// Numbers the scalars of a mechanism, and tells which of them are unknowns.

#include <vector>

#include "model/model.h"

namespace flexarm {

/// A variable is a block of scalars. The variables are, in this order: nodes (6 scalars: displacement, spin), joints
/// (their released coordinates; held joints last), and loop closures (their multipliers). Slave nodes, and prescribed
/// and mimicking coordinates, have no equations of their own.
struct DegreesOfFreedom {
  explicit DegreesOfFreedom(const Model& model);

  /// Appends a variable without equations, which only a solver knows. Returns it.
  int add_variable(int count);

  int variable_of_node(int node) const { return node; }
  int variable_of_joint(int joint) const { return node_count + joint; }
  int variable_of_closure(int closure) const { return node_count + joint_count + closure; }
  int scalar_of(const Coordinate& coordinate) const {
    return first[variable_of_joint(coordinate.joint)] + coordinate.component;
  }

  int node_count = 0, joint_count = 0;  ///< held joints included
  std::vector<int> size;                ///< per variable: number of its scalars
  std::vector<int> first;               ///< per variable: index of its first scalar
  std::vector<int> equation;            ///< per scalar: equation, or -1
  /// A run of consecutive scalars that are all unknowns; their equations are consecutive, too.
  struct Run {
    int scalar, equation, count;
  };
  std::vector<Run> runs;
  int scalar_count = 0;
  int unknowns = 0;              ///< number of equations
  std::vector<int> slave_joint;  ///< per node: the joint whose slave it is, or -1

  /// A coordinate that follows another one. Each of both is the only scalar of its variable.
  struct Mimic {
    int slave_variable, master_variable;
    int coordinate;  ///< index of the follower
  };
  std::vector<Mimic> mimics;  ///< an entry's master is never the slave of an earlier entry
};

}  // namespace flexarm
