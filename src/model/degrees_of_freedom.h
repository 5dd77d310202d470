#pragma once
/// Numbering: which scalars of the mechanism are unknowns.

#include <vector>

#include "model/model.h"

namespace flexarm {

/// Variables are blocks of scalars: first the nodes (6 scalars: displacement, spin), then the joints (their released
/// coordinates), those that are held last, then the closures of loops (their multipliers). A slave node, a prescribed
/// and a mimicking coordinate have no equation of their own.
struct DegreesOfFreedom {
  explicit DegreesOfFreedom(const Model& model);

  int variable_of_node(int node) const { return node; }
  int variable_of_joint(int joint) const { return node_count + joint; }
  int variable_of_closure(int closure) const { return node_count + joint_count + closure; }
  int scalar_of(const Coordinate& coordinate) const {
    return first[variable_of_joint(coordinate.joint)] + coordinate.component;
  }

  int node_count = 0, joint_count = 0;  ///< held joints included
  std::vector<int> size;                ///< per variable: scalars
  std::vector<int> first;               ///< per variable: index of its first scalar
  std::vector<int> equation;            ///< per scalar: equation, or -1
  /// Scalars that are unknowns, where their equations follow one another as they do.
  struct Run {
    int scalar, equation, count;
  };
  std::vector<Run> runs;
  int scalar_count = 0;
  int unknowns = 0;              ///< equations
  std::vector<int> slave_joint;  ///< per node: joint of which it is the slave, or -1

  /// A coordinate that follows another one; both are alone in their variables.
  struct Mimic {
    int slave_variable, master_variable;
    int coordinate;  ///< the following one
  };
  std::vector<Mimic> mimics;  ///< an entry's master is never the slave of an earlier entry
};

}  // namespace flexarm
