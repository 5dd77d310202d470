#pragma once
/// Replaces beams, bodies and the tangent's backend in steps in a plane.

#include <memory>

#include "integrators/planar_beams.h"
#include "model/plane_finder.h"
#include "solver/planar_tangent.h"

namespace flexarm {

struct PlanarStep {
  PlanarStep(const StepConfiguration& configuration, PlaneOfMotion found);
  PlanarStep(const PlanarStep&) = delete;  // the others refer to the plane

  /// Decides, by the state at its beginning alone, whether a step is taken in the plane. True if the last one was not
  /// where this one is.
  bool choose(const Model& model, const State& state);
  /// Takes round-off out of the newest increments: extrapolation would magnify it, and Newton's method leaves what is
  /// out of the plane as it is.
  void tidy(const StepConfiguration& configuration, IncrementHistory& history) const;
  /// The state was changed by somebody else.
  void invalidate() {
    is_sure = false;
    beams.invalidate();
  }

  PlaneOfMotion plane;
  PlanarBeams beams;
  PlanarTangent tangent;
  std::vector<Vector3> joint_normals;  ///< the normal in joints' frames
  bool is_on = false;                  ///< the step is taken in the plane
  bool is_sure = false;                ///< its end lies in the plane, too, unless somebody changes it
};

/// Null unless steps of the model by the scheme may be taken in a plane.
std::unique_ptr<PlanarStep> make_planar_step(const StepConfiguration& configuration);

}  // namespace flexarm
