#pragma once
/// The parts of a step in a plane: they replace the beams, bodies and the tangent's backend.

#include <memory>

#include "integrators/planar_beams.h"
#include "model/plane_finder.h"
#include "solver/planar_tangent.h"

namespace flexarm {

struct PlanarStep {
  PlanarStep(const StepConfiguration& configuration, PlaneOfMotion found);
  PlanarStep(const PlanarStep&) = delete;  // members refer to `plane`

  /// Decides whether a step is taken in the plane, from the state at its beginning alone. Returns whether this differs
  /// from the last step.
  bool choose(const Model& model, const State& state);
  /// Removes components out of the plane, which are round-off, from the newest increments. Extrapolation would magnify
  /// them, and Newton's method in the plane does not change them.
  void tidy(const StepConfiguration& configuration, IncrementHistory& history) const;
  /// To be called after the state was changed by something other than a step.
  void invalidate() {
    is_sure = false;
    beams.invalidate();
  }

  PlaneOfMotion plane;
  PlanarBeams beams;
  PlanarTangent tangent;
  std::vector<Vector3> joint_normals;  ///< normal of the plane in the frame of each joint
  bool is_on = false;                  ///< whether the step is taken in the plane
  bool is_sure = false;                ///< whether its end lies in the plane; invalidate() resets this
};

/// Null unless the model moves in a plane and the scheme supports steps in a plane.
std::unique_ptr<PlanarStep> make_planar_step(const StepConfiguration& configuration);

}  // namespace flexarm
