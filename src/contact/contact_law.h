#pragma once
/// What a point of a contact does over a step: it is pushed out, and it grips. (docs/notes/contact.md)

#include <limits>

#include "flexarm/math/pose.h"

namespace flexarm {

/// Of one contact point.
struct ContactLaw {
  double stiffness = 0;  ///< of shallow penetrations [N/m]
  double frequency = 0;  ///< of a hit: the root of the stiffness over what it moves, roughly [rad/s]
  double restitution = 1;
  double damping = 0;  ///< by which a hit gives back what the restitution says, see damping_for_restitution()
  double depth = std::numeric_limits<double>::infinity();  ///< beyond which it gives way no further [m]
  double most_start = 0;             ///< what starts no deeper inside is felt from its surface on [m]
  double friction = 0;               ///< coefficient
  double grip = 0;                   ///< stiffness along the surface where it sticks [N/m]
  double spinning = 0, rolling = 0;  ///< most of the couples about the normal and across it, of the push [m]
  double turn_grip = 0;              ///< stiffness of these where nothing turns [N m/rad]
  bool resists_turns() const { return spinning > 0 || rolling > 0; }
};

/// Hunt and Crossley's damping d of a hit that gives back `restitution` of its speed, from 0.05 to 1, whatever mass,
/// stiffness and speed are: (1 + d) / (1 - e d) = exp(d (1 + e)). (Gonthier et al. 2004)
double damping_for_restitution(double restitution);

/// Of the depth: no equilibrium is deeper.
constexpr double kDeepestRest = 0.95;

/// Of a penetration, > 0 inside [J].
double contact_energy(const ContactLaw& law, double penetration);

/// A penetration over a step.
struct ContactChange {
  double begin, end;  ///< [m]
  double duration;    ///< [s]; 0: an equilibrium
  double speed = 0;   ///< of the approach, by which the hit is damped [m/s]
};
/// Force by which it is pushed out [N], its derivative by the penetration at the end, and what is dissipated [J]. It
/// never pulls. Over a step it is the mean, whose work is exact: the change of the energy, and what is dissipated,
/// which is never negative. In an equilibrium it is that at the end.
struct ContactPush {
  double value = 0, slope = 0, dissipated = 0;
};
ContactPush contact_push(const ContactLaw& law, const ContactChange& change);

/// Force at an instant [N]: what contact_push() goes to in short steps. `rate`: of the penetration [m/s]; `speed`: of
/// the approach, see approach_speed(). (docs/notes/contact.md 2)
double push_at(const ContactLaw& law, double penetration, double rate, double speed);

/// True where the step is too long for a hit: it goes through a large part of it, by a large angle of the oscillator
/// that the contact is. `begin_rate`: of the penetration.
bool is_coarse_hit(const ContactLaw& law, const ContactChange& change, double begin_rate, double refinement);
/// The speed to be remembered for the next step, < 0 where the hit was on its way back: what comes in again from there
/// is a new hit.
double remembered_speed(const ContactChange& change, double begin_rate);
/// By which the hit is damped in the step. `remembered`: see remembered_speed(); `penetration`: both at the beginning.
double approach_speed(double penetration, double begin_rate, double remembered);

/// What goes in by less than this part of its radius on its way does not go through: what lies alongside something does
/// so by round-off.
constexpr double kGraze = 1e-6;

/// What is left of a start inside below this is nothing [m].
constexpr double kLeastStart = 1e-9;
/// What has started deep inside is felt from there on alone, and is let out little by little: so deep it still is at
/// the end of a step that begins at `start` [m]. (docs/notes/contact.md 5)
double let_out(const ContactLaw& law, double start, double duration);
/// How fast it is let out [m/s]: so much faster than the true penetration the felt one grows.
double let_out_rate(const ContactLaw& law, double start);

/// Stretch of what sticks, along the surface [m], at the end of the step, with its derivatives by the slip over the
/// step, the unit normal and the push. It pulls back with `grip` times it, at most by Coulomb's force. What it does at
/// the end stands for the step, so that sticking does not ring: it dissipates, and never the reverse.
struct ContactGrip {
  Vector3 stretch;
  Matrix3 by_slip, by_normal;
  Vector3 by_push;
};
ContactGrip contact_grip(const ContactLaw& law, const Vector3& stretch, const Vector3& slip, const Vector3& normal,
                         double push);
/// The same of what resists to spinning and rolling: `turned` and `turn` [rad], with `turn_grip`.
ContactGrip turn_grip(const ContactLaw& law, const Vector3& turned, const Vector3& turn, const Vector3& normal,
                      double push);

}  // namespace flexarm
