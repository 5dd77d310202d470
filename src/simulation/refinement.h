#pragma once
/// Decides which elements of beams with refine="true" are halved, and which halves are joined again.
/// (docs/notes/refinement.md)

#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// An element of the scene is divided into at most 2^kMostLevels parts.
constexpr int kMostLevels = 6;

/// Halves are looked at for joining once in this number of steps.
constexpr long kStepsBetweenJoins = 16;

/// Whether elements of a beam may be halved.
bool refines(const Model& model);

/// How far elements are bent that may be halved.
enum class Bending {
  Little,
  Strong,  ///< an element has to be halved, and may be halved in this state
  TooFar   ///< an element has to be halved in an earlier state, since halving it here would change the energy
};
Bending bending_of(const Model& model, const State& state);

/// The halvings of the model, and those of elements that are bent strongly or too far in `state`.
std::vector<HalvedElement> with_bent_halved(const Model& model, const State& state);

/// The halved elements whose halves are nearly straight together, the straightest one first.
std::vector<HalvedElement> straight_elements(const Model& model, const State& state);

/// Whether halves may be joined although the energy changes from that of `before` to that of `after`, two states of the
/// same instant: so little energy that the motion hardly notices.
bool is_small_change(const Energies& before, const Energies& after);

/// Writes the halvings into the scene.
void set_halved(const std::vector<HalvedElement>& halved, scene::SceneDescription& scene);

/// Why these cannot be the halvings of a state of the model; empty if they can.
std::string halving_flaw(const Model& model, const std::vector<HalvedElement>& halved);

/// @throws ModelError naming a beam with refine="true" that the scheme or something else in the scene does not allow.
void require_suitable_refinement(const scene::SceneDescription& scene, const Scheme& scheme, const Model& model);

/// Sets refine="true" for all beams with refine="auto" that allow it in a simulation of the scene with this model.
void refine_where_possible(const Scheme& scheme, const Model& model, scene::SceneDescription& scene);

/// @throws ModelError if a beam has refine="true". `what`: a computation that cannot take along changes of the mesh,
/// such as "a run to an accuracy".
void require_constant_mesh(const scene::SceneDescription& scene, const std::string& what);

}  // namespace flexarm
