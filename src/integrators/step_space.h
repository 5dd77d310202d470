#pragma once
/// The space of a step: beams, bodies and the tangent's backend in three dimensions, or in the plane in which the
/// mechanism moves. Nothing else asks which of them a step uses.

#include <memory>

#include "integrators/scheme_family.h"
#include "integrators/step_configuration.h"
#include "solver/tangent_backend.h"

namespace flexarm {

/// Whether steps of a mechanism that moves in a plane are computed in that plane. The results are the same.
enum class Space { ThreeDimensional, PlaneWhereFound };

class StepSpace {
 public:
  StepSpace(const StepConfiguration& configuration, const StepPrestrains& prestrains, BackendChoice backend,
            Space space);
  ~StepSpace();
  StepSpace(const StepSpace&) = delete;  // what is in the plane refers to members

  /// Decides whether a step is taken in the plane, from the state at its beginning alone.
  void choose(const State& state);
  /// Those of the step that is chosen.
  SchemeFamily& family() { return *family_; }
  TangentBackend& tangent() { return *tangent_; }
  const TangentBackend& tangent() const { return *tangent_; }
  /// Those in three dimensions.
  SchemeFamily& family_in_space() { return *spatial_family_; }
  TangentBackend& tangent_in_space() { return *spatial_tangent_; }

  /// Removes components out of the plane, which are round-off, from the newest increments. Extrapolation would magnify
  /// them, and Newton's method in the plane does not change them.
  void tidy(IncrementHistory& history) const;
  /// To be called after the state was changed by something other than a step.
  void invalidate();

 private:
  struct InPlane;

  const StepConfiguration& configuration_;
  std::unique_ptr<SchemeFamily> spatial_family_;
  std::unique_ptr<TangentBackend> spatial_tangent_;
  std::unique_ptr<InPlane> plane_;  // null unless the mechanism moves in a plane
  SchemeFamily* family_;
  TangentBackend* tangent_;
};

}  // namespace flexarm
