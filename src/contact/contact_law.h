#pragma once
/// The force law of a contact point over a step: normal force (push), friction, resistance to turning.
/// (docs/notes/contact.md)

#include <array>
#include <limits>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// The coefficient of restitution of hits as a function of the speed of approach: linear between the given speeds,
/// constant beyond them. With it, the damping d of Hunt and Crossley's law, see damping_for_restitution().
class Restitution {
 public:
  static constexpr std::size_t kMost = 8;

  Restitution() : Restitution(1) {}
  explicit Restitution(double value);
  /// `values`: from 0 to 1. `speeds`: as many, at most kMost, increasing; empty for one value [m/s].
  Restitution(const std::vector<double>& values, const std::vector<double>& speeds);

  double at(double speed) const;
  double damping_at(double speed) const;
  double of_slow_hits() const { return values_[0]; }
  double of_fast_hits() const { return values_[count_ - 1]; }
  double damping_of_slow_hits() const { return dampings_[0]; }

 private:
  std::size_t count_ = 1;
  std::array<double, kMost> values_ = {}, speeds_ = {}, dampings_ = {};
};

/// The parameters of one contact point.
struct ContactLaw {
  double stiffness = 0;  ///< for small penetrations [N/m]
  double frequency = 0;  ///< of a hit: about sqrt(stiffness / mass that it moves) [rad/s]
  Restitution restitution;
  double depth = std::numeric_limits<double>::infinity();  ///< largest possible penetration [m]
  double most_start = 0;             ///< initial penetrations up to this act fully at once; see let_out() [m]
  double friction = 0;               ///< Coulomb's coefficient
  double grip = 0;                   ///< tangential stiffness while it sticks, for small penetrations [N/m]
  double spinning = 0, rolling = 0;  ///< largest couple about the normal and across it, per normal force [m]
  double turn_grip = 0;              ///< stiffness of these couples while they stick [N m/rad]
  bool resists_turns() const { return spinning > 0 || rolling > 0; }
};

/// Returns the damping d of Hunt and Crossley's law for a coefficient of restitution e from 0 to 1, at least
/// kLeastRestitution (joints/stop_restitution.h), from (1 + d) / (1 - e d) = exp(d (1 + e)). It does not depend on
/// mass, stiffness or speed. (Gonthier et al. 2004)
double damping_for_restitution(double restitution);

/// The largest penetration in an equilibrium, relative to ContactLaw::depth.
constexpr double kDeepestRest = 0.95;

/// Returns the elastic energy of a penetration (> 0 inside) [J].
double contact_energy(const ContactLaw& law, double penetration);

/// A penetration over a step.
struct ContactChange {
  double begin, end;  ///< [m]
  double duration;    ///< [s]; 0: an equilibrium
  double speed = 0;   ///< of approach, see approach_speed() [m/s]
};
/// The normal force of a contact [N], its derivative with respect to the penetration at the end, and the dissipated
/// energy [J]. It never pulls. Over a step it is a mean force with exact work: the change of the elastic energy plus
/// the dissipated energy, which is never negative. In an equilibrium it is the force at the end.
struct ContactPush {
  double value = 0, slope = 0, dissipated = 0;
};
ContactPush contact_push(const ContactLaw& law, const ContactChange& change);

/// Returns the normal force at an instant [N], which is the limit of contact_push() for short steps. `rate`: of the
/// penetration [m/s]; `speed`: see approach_speed(). (docs/notes/contact.md 2)
double push_at(const ContactLaw& law, double penetration, double rate, double speed);

/// Whether the step is too long for a hit: it covers a large part of the hit, and advances the phase of the contact's
/// oscillator by a large angle. `begin_rate`: of the penetration [m/s].
bool is_coarse_hit(const ContactLaw& law, const ContactChange& change, double begin_rate, double refinement);
/// Returns the speed of approach that the contact's memory keeps for the next step. It is < 0 if the penetration was
/// decreasing; if it increases again, that is a new hit. 0 if the contact has ended.
double remembered_speed(const ContactChange& change, double begin_rate);
/// Returns the speed of approach, on which the damping in a step depends [m/s]. `penetration`, `begin_rate`: at the
/// beginning of the step; `remembered`: see remembered_speed().
double approach_speed(double penetration, double begin_rate, double remembered);

/// A ball passes through something only if it penetrates by more than this part of its radius. Bodies that lie
/// alongside each other penetrate by round-off.
constexpr double kGraze = 1e-6;

/// The offset of let_out() is set to zero below this [m].
constexpr double kLeastStart = 1e-9;
/// Returns the offset at the end of a step that begins with the offset `start` [m]. If a contact starts with a deep
/// penetration, this is taken as an offset: only penetrations beyond the offset cause a force. The offset decays
/// slowly, so that the bodies are not thrown apart. (docs/notes/contact.md 5)
double let_out(const ContactLaw& law, double start, double duration);
/// Returns the rate of decay of the offset [m/s]. The penetration beyond the offset grows faster than the true one by
/// this.
double let_out_rate(const ContactLaw& law, double start);

/// In a hit the tangential stiffness hardens as the normal one does: by the factor V''(p) / k of the penetration p at
/// the end. This is the factor's root, and its derivative with respect to p. It is 1 where the penetration is larger
/// than belongs to the speed of approach, since something presses. It is bounded, so that a step of the length
/// `duration` [s] damps what sticks. (docs/notes/contact.md 3)
struct GripRoot {
  double value = 1, slope = 0;
};
GripRoot grip_root(const ContactLaw& law, double penetration, double speed, double duration);

/// Friction as a tangential spring. `stretch`: at the end of the step [m], so that ContactLaw::grip / 2 times its
/// square is the stored energy. `pull`: the root of the hardening times the stretch [m]. The friction force is
/// ContactLaw::grip times the pull, at most Coulomb's force. The force at the end acts over the whole step. This
/// dissipates energy and never generates it, so that sticking contacts do not oscillate. Derivatives are those of the
/// pull with respect to the slip over the step, the unit normal, the normal force (push) and the root.
struct ContactGrip {
  Vector3 stretch, pull;
  Matrix3 by_slip, by_normal;
  Vector3 by_push, by_root;
};
ContactGrip contact_grip(const ContactLaw& law, const Vector3& stretch, const Vector3& slip, const Vector3& normal,
                         double push, double root);
/// The same for resistance to spinning and rolling, with ContactLaw::turn_grip. `turned`: stretch at the beginning
/// [rad]; `turn`: relative rotation over the step [rad].
ContactGrip turn_grip(const ContactLaw& law, const Vector3& turned, const Vector3& turn, const Vector3& normal,
                      double push, double root);

}  // namespace flexarm
