#include "model/line_release.h"

#include <algorithm>
#include <cassert>

namespace flexarm {
namespace {

double clamped(const SlideLine& line, double arc_length) {
  return std::clamp(arc_length, line.begin(), line.end());
}

/// Calls visit(joint) for the chain of joints from `last` back to the slide that carries them.
template <class Visit>
void for_each_in_chain(const Model& model, int slide, int last, const Visit& visit) {
  for (int j = last;;) {
    visit(j);
    if (j == slide) return;
    const auto is_carrier = [&](const JointMap& joint) { return joint.slave == model.joints[j].master; };
    j = static_cast<int>(std::find_if(model.joints.begin(), model.joints.end(), is_carrier) - model.joints.begin());
  }
}

}  // namespace

int slide_beyond_end(const Model& model, const State& state) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.leaving >= 0 && model.slide_lines[joint.line].overshoot(state.released[j].displacement[0]) > 0)
      return static_cast<int>(j);
  }
  return -1;
}

Model model_after_release(Model model, const State& state, int slide) {
  assert(slide >= 0 && model.joints[slide].leaving >= 0 && "one that has not left yet");
  JointMap& joint = model.joints[slide];
  const int last = joint.leaving;
  for_each_in_chain(model, slide, last, [&](int j) {
    for (int k = 0; k < released_count(model.joints[j].kind); ++k) {
      Coordinate& coordinate = model.coordinates[model.first_coordinate[j] + k];
      const double value = state.released[j].displacement[k % 3];
      coordinate.limit.reset();
      if (coordinate.mimicked >= 0) continue;  // it keeps following its master
      coordinate.motion = static_cast<int>(model.histories.size());
      model.histories.emplace_back(j == slide ? clamped(model.slide_lines[joint.line], value) : value);
    }
  });
  joint.leaving = -1;
  model.node_parents[model.joints[last].slave] = -1;
  model.node_parents.push_back(model.joints[last].master);
  model.joints[last].slave = static_cast<int>(model.nodes.size());
  model.nodes.push_back(model.nodes.back());
  model.inertias.emplace_back();
  model.initial_velocity.push_back(Vector6::Zero());
  return model;
}

State state_after_release(const Model& model, State state, int slide) {
  assert(slide >= 0 && model.joints[slide].leaving >= 0 && "the model before the release");
  const JointMap& joint = model.joints[slide];
  double& arc_length = state.released[slide].displacement[0];
  if (model.coordinates[model.first_coordinate[slide]].mimicked < 0)
    arc_length = clamped(model.slide_lines[joint.line], arc_length);
  state.nodes.push_back(state.nodes[model.joints[joint.leaving].slave]);
  for (auto* per_node : {&state.study.forces, &state.study.reactions})
    if (!per_node->empty()) per_node->push_back(Vector6::Zero());
  for (auto* per_node : {&state.study.total_rotations, &state.study.momentum_rates})
    if (!per_node->empty()) per_node->push_back(Vector3::Zero());
  state.history.clear();
  state.left_lines.push_back(slide);
  return state;
}

}  // namespace flexarm
