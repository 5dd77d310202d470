#pragma once
/// Writes data of one element into a lane of a pack of elements; shared by spatial and planar packs.

#include "math/lanes.h"
#include "model/beam_element.h"

namespace flexarm {

/// Writes the shape functions and the weight of an integration point.
template <class PackPoint, class Point>
void set_interpolation_lane(PackPoint& pack, int lane, const Point& point) {
  set_lane(pack.shape, lane, point.shape);
  set_lane(pack.derivative, lane, point.derivative);
  set_lane(pack.weight, lane, point.weight);
}

/// Writes mass and damping, except the damping scales of single strains.
template <class Pack, int Nodes>
void set_mass_and_damping_lane(Pack& pack, int lane, const BeamElement<Nodes>& element) {
  set_lane(pack.mass, lane, element.mass);
  set_lane(pack.stiffness_damping, lane, element.stiffness_damping);
  set_lane(pack.mass_damping, lane, element.mass_damping);
  pack.is_damped_evenly = pack.is_damped_evenly && is_damped_evenly(element);
  pack.has_stiffness_damping = pack.has_stiffness_damping || element.stiffness_damping != 0;
  pack.has_mass_damping = pack.has_mass_damping || element.mass_damping != 0;
}

}  // namespace flexarm
