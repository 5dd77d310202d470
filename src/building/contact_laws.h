#pragma once
/// Shared by the builders of all kinds of contact: laws of their points, and the state at the start.

#include <limits>
#include <optional>

#include "contact/contact_element.h"
#include "model/model.h"

namespace flexarm {

/// A start inside is at most this part of the depth beyond which a contact gives way no further.
constexpr double kStartInside = 0.25;
constexpr double kThrownOut = 0.1;  // m/s

/// Of a contact of two bodies.
struct LawRequest {
  double mass;                           ///< that a hit moves, of both: 1 / m = 1 / m1 + 1 / m2 [kg]
  double at_a_time;                      ///< points that touch at a time
  std::optional<double> stiffness = {};  ///< of a point [N/m]; empty: a hit lasts kContactSteps steps
  double softest = std::numeric_limits<double>::infinity();  ///< than which a stiffness that is not given is no higher
  double restitution = 1, friction = 0;
};
/// Law of each point, without a depth. `step`: of the scene [s]. (docs/notes/contact.md 2, 3)
ContactLaw law_of_points(const LawRequest& request, double step);

/// Mass of a body [kg]. For a body without a mass of its own, which other bodies hold, the mass of all; infinite for
/// the world (-1).
double mass_of_body(const Model& model, int node);

/// Lets a contact start `deepest` inside [m]: its depth is such that this is kStartInside of it at most. What is deeper
/// than that part of the depth that it has now, or would be thrown out with more than kThrownOut, is let out slowly.
void allow_start(ContactLaw& law, double deepest);

/// How deep the deepest of all stations starts inside of the shapes; < 0: how near to them the nearest one is [m].
double deepest_start(const Model& model, const ContactStations& side, const ContactSurface& surface);

}  // namespace flexarm
