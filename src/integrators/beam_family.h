#pragma once
/// All beams of a model over a step: one part of the step for each family of schemes.

#include <memory>

#include "integrators/balance.h"
#include "integrators/hht_interpolation.h"
#include "integrators/step_prestrains.h"

namespace flexarm {

/// Forces and inertia of beams. One call is for all elements.
class BeamFamily {
 public:
  virtual ~BeamFamily() = default;

  /// Adds to an initial state what the family keeps there.
  virtual void initialise(State&) {}
  /// See RotationReference.
  virtual void forget_path(State&) {}
  /// The configuration's step has begun.
  virtual void begin() = 0;
  /// Internal forces and damping; in families that have their inertia at the same points, that as well.
  virtual void add_forces(Balance& balance) = 0;
  /// What add_forces() leaves, once all forces are in the balance.
  virtual void add_inertia(Balance&) {}
  /// After a tangent, before its solution moves the nodes, {dr, spin} in `update`, 6 numbers each: carries the stresses
  /// along for the next tangent (docs/notes/newton.md).
  virtual void carry_strains(const double*) {}
  /// Whether the geometric part of the next tangent sees other stresses than the residual.
  virtual bool carries_strains() const { return false; }
  /// Work of prestrains that change over the step, in the trial configuration that was evaluated last [J].
  virtual double work_of_prestrains() const = 0;
  /// Writes what the family keeps of the trial configuration, evaluated last, into the state.
  virtual void accept(State& state) = 0;
  /// The state was changed by somebody else: what was kept from the last step does not hold.
  virtual void invalidate() = 0;
  /// Per node, of the trial configuration: rotation vectors from the undeformed state, where the scheme keeps them.
  virtual const std::vector<Vector3>& total_rotations() const;
  /// To be set before the first step where forces are interpolated in time.
  virtual void set_interpolation(HhtInterpolation*) {}
  /// Whether add_forces() heeds TangentBackend::condensation().
  virtual bool evaluates_packs() const { return false; }
};

/// The family of the configuration's scheme.
std::unique_ptr<BeamFamily> make_beam_family(const StepConfiguration& configuration, const StepPrestrains& prestrains);

}  // namespace flexarm
