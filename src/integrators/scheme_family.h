#pragma once
/// Interface for what differs between families of schemes: beams, and the inertia of beams and nodes, over a step.

#include <memory>

#include "integrators/balance.h"
#include "integrators/step_prestrains.h"

namespace flexarm {

class NodalForces;

/// Each call handles all elements and nodes. The families here are ConservingBeams, PlanarBeams and, for equilibria,
/// StaticBeams; those of other schemes are in the room study_schemes/.
class SchemeFamily {
 public:
  virtual ~SchemeFamily();

  /// Adds the data that the family keeps in the state to an initial state, which the configuration must have begun.
  virtual void initialise(State&) {}
  /// Replaces rotations that the family keeps by those that follow from the nodes of the state, independent of the path
  /// to it.
  virtual void forget_path(State&) {}
  /// Starts a step. The configuration must have begun it.
  virtual void begin() = 0;
  /// Adds internal forces and damping, in some families also inertia: if it is evaluated at the same points.
  virtual void add_forces(Balance& balance) = 0;
  /// Adds weights and loads, as NodalForces::evaluate() does; a family may interpolate them in time.
  virtual void add_loads(const NodalForces& loads, Balance& balance);
  /// Adds the inertia that add_forces() does not. Called when all forces are in the balance; not in statics.
  virtual void add_inertia(Balance&) {}
  /// Updates the carried strains for the next tangent (docs/notes/newton.md). To be called after a tangent was
  /// factorised, and before its solution moves the nodes. The argument is the update {dr, spin}, 6 numbers per node.
  virtual void carry_strains(const double*) {}
  /// Whether the geometric part of the next tangent uses other stresses than the residual.
  virtual bool carries_strains() const { return false; }
  /// Work of prestrains that change over the step, in the trial configuration of the last evaluation [J].
  virtual double work_of_prestrains() const { return 0; }
  /// A node's motion at the end of the step.
  virtual NodeState motion_at_end(int node) const = 0;
  /// Writes the nodes' motion at the end of the step, and the family's data of the trial configuration, which was
  /// evaluated last, into the state.
  virtual void accept(State& state) = 0;
  /// Discards data kept from the last step. To be called after the state was changed by something other than a step.
  virtual void invalidate() = 0;
  /// Whether add_forces() supports TangentBackend::condensation().
  virtual bool evaluates_packs() const { return false; }
};

/// Creates the family of the configuration's scheme.
/// @throws ModelError if the scheme is for study and the library of these schemes cannot be loaded
std::unique_ptr<SchemeFamily> make_scheme_family(const StepConfiguration& configuration,
                                                 const StepPrestrains& prestrains);

}  // namespace flexarm
