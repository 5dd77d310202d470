#pragma once
/// A contact law with friction, for tests of contact points over a step.

#include "contact/contact_law.h"

namespace flexarm::test {

/// Returns a law of contact. `depth` is in m.
inline ContactLaw gripping_law(double friction, double restitution, double depth) {
  ContactLaw law;
  law.stiffness = 500;
  law.frequency = 20;
  law.restitution = Restitution(restitution);
  law.depth = depth;
  law.friction = friction;
  law.grip = 400;
  return law;
}

}  // namespace flexarm::test
