#pragma once
/// What functions of a state for output look at.

#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

struct MotionView {
  const Model& model;
  const DegreesOfFreedom& dof;
  const TimeRule& rule;
  const State& state;
};

}  // namespace flexarm
