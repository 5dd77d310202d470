#pragma once
/// What builders of all kinds of contact share: the laws of contact points, and how deep bodies overlap at the start.

#include <limits>
#include <optional>

#include "contact/contact_element.h"
#include "flexarm/scene/contact_description.h"
#include "model/model.h"

namespace flexarm {

/// Largest overlap at the start, relative to the depth beyond which a contact gives way no further.
constexpr double kStartInside = 0.25;
constexpr double kThrownOut = 0.1;  // m/s; largest speed at which bodies that overlap at the start are pushed apart

/// The requirements for the law of a contact of two bodies.
struct LawRequest {
  double mass;                           ///< that a hit moves: 1 / m = 1 / m1 + 1 / m2 of both bodies [kg]
  double at_a_time;                      ///< number of points that touch at a time
  double contact_time;                   ///< that a hit lasts [s]
  std::optional<double> stiffness = {};  ///< of a point [N/m]; empty: by the contact time
  double softest = std::numeric_limits<double>::infinity();  ///< bound of a stiffness that is not given [N/m]
  scene::RestitutionDescription restitution = {};
  double friction = 0;
  double grip = 1;  ///< stiffness of sticking friction, relative to that of the normal force
};
/// Law of each point, without a depth. (docs/notes/contact.md 2, 3)
ContactLaw law_of_points(const LawRequest& request);

/// Mass of a body [kg]. For a body without mass, which other bodies hold, the mass of the whole mechanism. Infinite for
/// the world (-1).
double mass_of_body(const Model& model, int node);

/// Lets bodies overlap by `deepest` at the start [m]: the depth is increased so that this is at most the part
/// kStartInside of it. An overlap above this part of the depth as it was before is reduced slowly, and so is one that
/// would push bodies apart faster than kThrownOut.
void allow_start(ContactLaw& law, double deepest);

/// How deep the deepest station is inside of the shapes at the start; if < 0, how near the nearest one is to them [m].
double deepest_start(const Model& model, const ContactStations& side, const ContactSurface& surface);

}  // namespace flexarm
