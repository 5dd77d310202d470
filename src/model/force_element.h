#pragma once
/// Elements that act between points of the mechanism: one class for each kind.

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/joint.h"

namespace flexarm {

struct State;

/// A point fixed to a node, or to the world (-1).
struct NodePoint {
  int node = -1;
  Vector3 arm = Vector3::Zero();  ///< in the node's frame, or where it is in the world [m]
};

/// The beginning of a step, or what an equilibrium or small motions are about.
struct ForceStart {
  const std::vector<NodePose>& poses;      ///< of all nodes
  const std::vector<Vector6>& velocities;  ///< {v, w} of all nodes, world axes
  double duration = 0;                     ///< of the step [s]; 0: there is none
};

/// The step, or the equilibrium, that a force element is asked about.
struct ForceStep {
  const std::vector<NodePose>& begin;  ///< of all nodes
  const std::vector<NodePose>& end;
  const std::vector<Vector6>& velocities;  ///< {v, w} of all nodes at the beginning, world axes; not of equilibria
  double duration = 0;                     ///< [s]; 0: an equilibrium, in which nothing has a rate
  bool at_end = false;                     ///< forces are those at the end; else means whose work is exact
  double gamma = 1;                        ///< of rates, as CoordinateStep has it
  double refinement = 1;                   ///< by how much finer than usual what happens fast is to be resolved
  const double* memory = nullptr;          ///< at the beginning, memory_size() numbers
  double* new_memory = nullptr;            ///< at the end, as many, to be written
};

/// What a force element adds to the balance of a step. Of the nodes it acts on, in their order: {force, moment} and
/// {displacement, spin} of each, world axes.
struct ForceAction {
  Eigen::Map<Eigen::VectorXd> residual;  ///< to be set: less the forces on the nodes
  Eigen::Map<Eigen::MatrixXd> tangent;   ///< to be set: its derivative by motions at the end; no rows: not asked for
  double dissipated = 0;                 ///< over the step [J]
  double work = 0;                       ///< done on the mechanism from outside, over the step [J]
};

/// A force element as springs and dampers of a few measures of its nodes' poses: a length, a gap. Its forces are those
/// of tensions, rows^T tension.
struct ForceMeasures {
  Eigen::MatrixXd rows;       ///< per measure: its derivative by {displacement, spin} of the nodes, world axes
  Eigen::MatrixXd stiffness;  ///< of tensions by measures; positive semi-definite
};
struct DamperTensions {
  Eigen::VectorXd tension;
  Eigen::MatrixXd slope;  ///< by the measures' rates
};

/// A distance within which nodes may move before an element can act. When the fastest node has gone a way and another
/// one has turned by an angle, by_way * way + by_turn * angle of it are used up.
struct ForceRoom {
  double size = 0;     ///< [m]; 0 or less: it may act in the next step
  double by_way = 0;   ///< of any node, no unit
  double by_turn = 0;  ///< of any node [m/rad]
};

/// A number that is put out: the last part of its column's name, and its unit.
struct ForceOutput {
  const char* name;
  const char* unit;
};

/// What a contact has to touch with: its points, and the law of each.
struct TouchLaw {
  std::size_t points = 0;                                           ///< 0: it is no contact
  double stiffness = 0;                                             ///< of shallow penetrations [N/m]
  double restitution = 1, friction = 0, spinning = 0, rolling = 0;  ///< couples: of the push [m]
};

/// Poses and velocities of all nodes for output.
struct ForceMotion {
  const State& state;
  const std::vector<Vector6>& velocities;  ///< {v, w}, world axes
  const double* memory;                    ///< the element's own part of State::force_memory
};

/// A point at which an element's first link touches its second one, see ForceElement::links(), at an instant: as the
/// law has it there, with the friction that the last step has left.
struct TouchingPoint {
  Vector3 position;                  ///< on the surface of the first, from where those of nodes are, world axes [m]
  Vector3 normal;                    ///< unit, from the second to the first
  Vector3 push, friction;            ///< on the first, along the normal and across it [N]
  Vector3 couple = Vector3::Zero();  ///< on the first, which resists to spinning and rolling [N m]
  double gap = 0;                    ///< < 0: so deep is one in the other [m]
};
using TouchingPointTaker = std::function<void(const TouchingPoint&)>;

/// What acts between points of the mechanism. Constant, as the model is whose part it is; what it remembers is in the
/// state. Steps, energies, equilibria, modes, linear models, sensitivities and results know force elements by this
/// class alone.
class ForceElement {
 public:
  /// `reach`: all nodes that it may ever act on, each once.
  ForceElement(std::string name, std::vector<int> reach) : name_(std::move(name)), reach_(std::move(reach)) {}
  virtual ~ForceElement() = default;

  /// As the scene's element is called: "spring".
  virtual const char* kind() const = 0;
  /// Empty: it has none, and no columns.
  const std::string& name() const { return name_; }
  /// What `flexarm check` says of one that a ForceElementDescription has made, but for its kind, name and links.
  virtual std::string description() const { return {}; }
  /// Names of the links that it acts between, where it comes of no ForceElementDescription, which knows them. All
  /// contacts of a pair have them in the same order.
  virtual std::vector<std::string> links() const { return {}; }

  // ---- where
  const std::vector<int>& reach() const { return reach_; }
  /// Most nodes that it acts on in one step. Fewer than its reach where these change from step to step.
  virtual int most_nodes() const { return static_cast<int>(reach_.size()); }
  /// Writes those on which it may act in a step that begins so, each once; returns how many. Without a duration: all
  /// of its reach.
  virtual int find_nodes(const ForceStart& start, int* nodes) const {
    static_cast<void>(start);
    std::copy(reach_.begin(), reach_.end(), nodes);
    return static_cast<int>(reach_.size());
  }

  /// Room from the poses of `start` on. Until it is used up find_nodes() finds none, and needs_halves() is false. What
  /// a step that begins adds to the motion is taken as twice its duration at the speeds of its beginning; what a step
  /// that has been solved adds is its motion.
  virtual ForceRoom room(const ForceStart& start) const {
    static_cast<void>(start);
    return {};
  }

  // ---- what it does. `nodes`: as find_nodes() has written them. What acts on none and remembers nothing is not asked
  virtual void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const = 0;
  /// True where a step that has been solved is too long for what happens in it: it is done again by halves. Also of an
  /// element that acts on no nodes in the step, but would have to.
  virtual bool needs_halves(const ForceStep& step, const int* nodes, int count) const {
    static_cast<void>(step), static_cast<void>(nodes), static_cast<void>(count);
    return false;
  }
  /// True where something is hit in steps in which it acts on nodes: they may have to be halved more often than others.
  virtual bool hits() const { return false; }
  /// What it stores [J]. `memory`: its own part of State::force_memory.
  virtual double energy(const State& state, const double* memory) const = 0;
  virtual ForceMeasures measures(const State& state, const int* nodes) const = 0;
  /// Of rates of the measures, one for each.
  virtual DamperTensions dampers(const State& state, const Eigen::VectorXd& rates) const = 0;
  /// Numbers of State::force_memory that it has for itself.
  virtual int memory_size() const { return 0; }
  /// Writes those that are not zero at a start to which no motion has led: that of a scene, or one that was set.
  virtual void start(const State& state, double* memory) const { static_cast<void>(state), static_cast<void>(memory); }
  /// Whether any of these, at `memory`, is not zero.
  bool remembers(const double* memory) const {
    return std::any_of(memory, memory + memory_size(), [](double number) { return number != 0; });
  }

  /// False where it has no forces at the ends of steps, as the Newmark family asks for them, and steps backwards, as
  /// compositions have them, would undo what it dissipates.
  virtual bool suits_all_schemes() const { return true; }

  // ---- what it puts out
  virtual std::vector<ForceOutput> outputs() const { return {}; }
  /// Appends their values.
  virtual void put_out(const ForceMotion& motion, std::vector<double>& values) const {
    static_cast<void>(motion), static_cast<void>(values);
  }
  /// Of a contact, whose links() are two: calls `take` of each point that touches. Returns the smallest gap between
  /// both links, < 0 where they touch [m].
  virtual double touch(const ForceMotion& motion, const TouchingPointTaker& take) const {
    static_cast<void>(motion), static_cast<void>(take);
    return std::numeric_limits<double>::infinity();
  }
  virtual TouchLaw touch_law() const { return {}; }

 protected:
  ForceElement(const ForceElement&) = default;
  ForceElement& operator=(const ForceElement&) = delete;

 private:
  std::string name_;
  std::vector<int> reach_;
};

using ForceElementList = std::vector<std::shared_ptr<const ForceElement>>;

/// On which it acts in a step that begins so, in the memory of `nodes`; allocates the first time alone.
void find_nodes(const ForceElement& element, const ForceStart& start, std::vector<int>& nodes);
/// On which each acts in small motions about a state.
std::vector<std::vector<int>> nodes_of(const ForceElementList& elements, const State& state);

}  // namespace flexarm
