#pragma once
/// Forward dynamics of a tree of rigid bodies at an instant, by articulated bodies: O(n), without a mass matrix.
/// (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 7; docs/notes/explicit.md) It releases whole joints and
/// takes for granted that they have inertia; building/articulated_inertia.cpp asks whether they do, coordinate by
/// coordinate, at the start and with beams, slides and driven joints held.

#include <vector>

#include "joints/joint_map.h"
#include "math/padded_vectors.h"
#include "model/model.h"

namespace flexarm {

/// The tree of a model without beams, slides and loop closures. Allocates no memory after construction.
class ArticulatedBodies {
 public:
  explicit ArticulatedBodies(const Model& model);

  /// Number of rates, of all joints together. A joint's rates are those of released_rates().
  int rate_count() const { return rate_count_; }
  int first_rate(int joint) const { return links_[joint].first; }

  /// Sets the configuration and the rates, and all forces to those of gravity. `released`: per joint. `rates`: of all
  /// joints.
  void set(const std::vector<Released>& released, const double* rates);
  Matrix3 rotation(int node) const { return bodies_[node].rotation.matrix(); }
  Vector3 position(int node) const { return bodies_[node].position.vector(); }
  Vector6 velocity(int node) const { return bodies_[node].velocity.vector(); }  ///< {v, w}, world axes
  /// Adds {force, moment about the node} on a node, world axes.
  void add_force(int node, const Vector6& force) { bodies_[node].bias -= PaddedSpatial(force); }
  /// Computes the derivatives of the rates. `efforts`, `armatures`: per rate; the latter is an inertia that moves with
  /// the joint alone, such as that of a rotor [kg m^2 or kg]. `rates_change`: output.
  void accelerate(const double* efforts, const double* armatures, double* rates_change);
  Vector6 acceleration(int node) const { return bodies_[node].acceleration.vector(); }  ///< d{v, w}/dt

  // For rates that depend on each other, instead of accelerate():
  /// Sets the accelerations of all nodes to those with these derivatives of the rates.
  void set_accelerations(const double* rates_change);
  /// Computes the efforts that these accelerations need. To be called before find_mass_matrix().
  void find_needed_efforts(const double* rates_change, const double* armatures, double* efforts);
  /// After find_needed_efforts(): {force, moment about the slave} that a joint transmits to its slave, world axes.
  Vector6 transmitted(int joint) const { return forces_[links_[joint].slave].vector(); }
  /// Computes the mass matrix of the rates, by composite bodies (Featherstone 2008, ch. 6). set() is needed after it.
  void find_mass_matrix(const double* armatures, Eigen::MatrixXd& mass);
  /// Adds the power of a force {f, m} on a node per unit of each rate to `row`; world axes. `node`: -1 is the world.
  void add_power(int node, const Vector6& force, double* row) const;

 private:
  struct Body {
    double mass = 0;
    PaddedMatrix3 rotary;  // in the node's frame
    PaddedMatrix3 rotation;
    Padded3 position;
    PaddedSpatial velocity, bias, acceleration;  // bias: the force at the node that keeps its acceleration zero
                                                 // (Featherstone's bias force of the articulated body)
    PaddedInertia inertia;                       // of the articulated body
  };
  struct Link {
    JointMapKind kind;
    int master, slave, first, count;
    Padded3 origin, translation, rotation, arm;  // as in JointMap
    double turn;                                 // angle per unit of a scalar coordinate
    bool travels;                                // whether the translation is not zero
    PaddedMatrix3 frame, slave_frame;            // of the joint in its master, of the slave in the moved joint
    PaddedMatrix3 turned_once, turned_twice;     // slave_frame, multiplied by hat(axis) once and twice
    const CamProfile* profile;
    // at an instant
    Padded3 way;               // from master to slave
    PaddedSpatial columns[6];  // of the slave's velocity by the rates: the first `count`
    PaddedSpatial drift;       // the slave's acceleration without those of the master and the rates
    PaddedSpatial held[6];     // inertia * columns * (columns^T inertia columns + armatures)^-1
    double change[6];          // of the rates, if the slave were not accelerated
  };
  /// What a joint does at an instant, world axes: the slave's rotation, the ways from the master to the moved joint
  /// frame and from there to the slave, and the joint's own velocity, angular velocity, and acceleration at constant
  /// rates.
  struct Motion {
    PaddedMatrix3 rotation;
    Padded3 to_joint, arm, sliding, turning, bend;
  };
  void move(Link& link, const Released& released, const double* rates);
  static void move_scalar(Link& link, double u, double rate, const PaddedMatrix3& master, Motion& out);
  static void move_frame(Link& link, const Released& released, const double* rates, const PaddedMatrix3& master,
                         Motion& out);
  void pass_on(Link& link, const double* efforts, const double* armatures);
  template <int Count>
  static void release(Link& link, const double* efforts, const double* armatures, PaddedInertia& inertia,
                      PaddedSpatial& bias);
  void follow(const Link& link, double* rates_change);
  void add_power(int node, PaddedSpatial force, double* row) const;
  /// The acceleration of a joint's slave if the rates do not change.
  PaddedSpatial carried_acceleration(const Link& link) const;

  Body world_;
  std::vector<Body> bodies_;           // per node
  std::vector<Link> links_;            // per joint, from the root to the leaves
  std::vector<int> carriers_;          // per node: the joint whose slave it is
  std::vector<PaddedSpatial> forces_;  // per node, scratch memory
  Padded3 gravity_;
  int rate_count_ = 0;
};

}  // namespace flexarm
