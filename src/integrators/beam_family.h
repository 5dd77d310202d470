#pragma once
/// Interface for all beams of a model over a step. Each family of schemes has its own implementation.

#include <memory>

#include "integrators/balance.h"
#include "integrators/hht_interpolation.h"
#include "integrators/step_prestrains.h"

namespace flexarm {

/// Forces and inertia of beams. Each call handles all elements.
class BeamFamily {
 public:
  virtual ~BeamFamily() = default;

  /// Adds the data that the family keeps in the state to an initial state.
  virtual void initialise(State&) {}
  /// See RotationReference::forget_path().
  virtual void forget_path(State&) {}
  /// Starts a step. The configuration must have begun it.
  virtual void begin() = 0;
  /// Adds internal forces and damping, in some families also inertia: if it is evaluated at the same points.
  virtual void add_forces(Balance& balance) = 0;
  /// Adds the inertia that add_forces() does not. Called when all forces are in the balance.
  virtual void add_inertia(Balance&) {}
  /// Updates the carried strains for the next tangent (docs/notes/newton.md). To be called after a tangent was
  /// factorised, and before its solution moves the nodes. The argument is the update {dr, spin}, 6 numbers per node.
  virtual void carry_strains(const double*) {}
  /// Whether the geometric part of the next tangent uses other stresses than the residual.
  virtual bool carries_strains() const { return false; }
  /// Work of prestrains that change over the step, in the trial configuration of the last evaluation [J].
  virtual double work_of_prestrains() const = 0;
  /// Writes the family's data of the trial configuration, which was evaluated last, into the state.
  virtual void accept(State& state) = 0;
  /// Discards data kept from the last step. To be called after the state was changed by something other than a step.
  virtual void invalidate() = 0;
  /// Per node, in the trial configuration: rotation vectors from the undeformed state. Empty if the scheme has none.
  virtual const std::vector<Vector3>& total_rotations() const;
  /// To be called before the first step of a scheme that interpolates forces in time.
  virtual void set_interpolation(HhtInterpolation*) {}
  /// Whether add_forces() supports TangentBackend::condensation().
  virtual bool evaluates_packs() const { return false; }
};

/// Creates the family of the configuration's scheme.
std::unique_ptr<BeamFamily> make_beam_family(const StepConfiguration& configuration, const StepPrestrains& prestrains);

}  // namespace flexarm
