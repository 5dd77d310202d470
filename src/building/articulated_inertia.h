#pragma once
/// What resists joints at the start: inertias, and joints whose motions have none together, though each has some
/// (internal to building/).

#include <vector>

#include "model/model.h"

namespace flexarm {

/// Coordinates that are free to move, but at the start only as others outboard of them move anyway: two axes in line
/// with nothing that has inertia between them, a gimbal in its lock, a massless chain of more joints than the body at
/// its end has freedoms. The accelerations of all of these would be undetermined. Of mechanisms without loops; beams
/// count as rigid, as they have inertia everywhere. `node_parents`: see Mechanism.
std::vector<int> coordinates_without_own_inertia(const std::vector<int>& node_parents, const Model& model);

/// Per coordinate what it moves at the start while those outboard of it are free to move, a rotor that turns with it
/// included [kg m^2 or kg]; 0 where that is not known: in mechanisms with loops, on slides, of coordinates that are
/// prescribed, follow others or are followed. Of a joint with several, those before it are free, too.
std::vector<double> articulated_inertias(const std::vector<int>& node_parents, const Model& model);

}  // namespace flexarm
