#pragma once
/// Closes the energy balance of a converged step by scaling velocities (beyond.md 1.2).

#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Scales the part of the velocities that rigid motions of the whole do not make up, which leaves momenta as they are.
/// Every tree that hangs from the world by one joint moves rigidly as that joint allows.
class VelocityScaling {
 public:
  /// @throws ModelError if motions are prescribed: velocities that somebody drives cannot be scaled.
  VelocityScaling(const Model& model, const Scheme& scheme);

  /// Gives `state` the energy that `begin` had, plus work, less dissipation. What cannot be given because nothing moves
  /// but rigidly, or a motion is only starting, is carried to the next step. False, and the state is not to be used, if
  /// the factor differs from one by more than 2 %: the step was too long.
  bool apply(const State& begin, State& state);

 private:
  struct Tree {
    std::vector<int> chain;    // elementary joints that hold it to the world
    int coordinates = 0;       // of the chain
    Matrix6 inertia;           // of the whole, locked, about the world's origin
    Vector6 momentum, motion;  // {p, L}; {v at the origin, w} of the rigid part
  };
  void project(const State& state);

  const Model& model_;
  Scheme scheme_;
  std::vector<Tree> trees_;
  std::vector<int> tree_of_node_;
  double mass_ = 0;
};

}  // namespace flexarm
