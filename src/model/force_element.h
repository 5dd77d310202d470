#pragma once
/// The interface of force elements, which act between points of the mechanism, such as springs and contacts. Each kind
/// is a class derived from ForceElement.

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/joint.h"

namespace flexarm {

struct State;

/// A point fixed to a node, or to the world (node -1).
struct NodePoint {
  int node = -1;
  Vector3 arm = Vector3::Zero();                    ///< from the node, in its frame; or the position in the world [m]
  Quaternion orientation = Quaternion::Identity();  ///< of the link's frame, in the node's frame or in the world
};

/// The configuration at the beginning of a step, or the one about which an equilibrium or small motions are computed.
struct ForceStart {
  const std::vector<NodePose>& poses;      ///< of all nodes
  const std::vector<Vector6>& velocities;  ///< {v, w} of all nodes, world axes
  double duration = 0;                     ///< of the step [s]; 0: no step
};

/// The value of a function of time over a step. In an equilibrium all three are the same.
struct FunctionStep {
  double begin = 0, end = 0;
  double mean = 0;  ///< only for elements that use means, see ForceElement::uses_means()
};

/// What an element finds at the beginning of a step and uses in each of its evaluations. An element that needs it
/// derives its own kind.
struct ForceWorkspace {
  ForceWorkspace() = default;
  ForceWorkspace(const ForceWorkspace&) = delete;
  ForceWorkspace& operator=(const ForceWorkspace&) = delete;
  virtual ~ForceWorkspace() = default;
};

/// The step or equilibrium for which a force element is evaluated.
struct ForceStep {
  const std::vector<NodePose>& begin;  ///< of all nodes
  const std::vector<NodePose>& end;
  const std::vector<Vector6>& velocities;   ///< {v, w} of all nodes at the beginning, world axes; not in equilibria
  double duration = 0;                      ///< [s]; 0: an equilibrium, in which all rates are zero
  bool at_end = false;                      ///< forces are those at the end; else means over the step, with exact work
  double gamma = 1;                         ///< of the rule for rates, see CoordinateStep
  double refinement = 1;                    ///< factor by which fast events are resolved more finely than by default
  double load_factor = 1;                   ///< by which an equilibrium is asked for a part of the given forces
  const FunctionStep* functions = nullptr;  ///< one for each of functions()
  const double* memory = nullptr;           ///< the element's memory at the beginning, memory_size() numbers
  double* new_memory = nullptr;             ///< output: the memory at the end, memory_size() numbers
  ForceWorkspace* workspace = nullptr;      ///< the element's own, in which begin() has begun the step
};

/// How the tangent of a force element that acts on many nodes is composed: of blocks of two nodes each, its pieces, and
/// of groups of auxiliary variables. Solvers then need not couple all nodes with each other. (docs/notes/tree.md 5)
struct ForcePieces {
  std::vector<std::array<int, 2>> pairs;  ///< per piece: indices into reach(), -1: none; empty: one dense matrix
  /// Per group: the nodes with which its auxiliary variables are coupled, indices into reach(), each once. They are
  /// also coupled with each other, and with those of the group before and behind.
  std::vector<std::vector<int>> groups;
  int rank = 0;  ///< the number of auxiliary variables of each group, at most 6; 0: groups do not count

  /// The sum of the numbers of nodes of all groups.
  std::size_t group_nodes() const;
};

/// A tangent that consists of pieces: the sum of their blocks, plus left inner^-1 right. That is, motions x determine
/// auxiliary variables t by inner t = right x, and t determines the forces left t. Each group has its own variables;
/// `inner` couples a group with its two neighbours only. Nodes are listed by groups, one group after the other.
struct PieceTangent {
  Eigen::Map<Eigen::MatrixXd> blocks{nullptr, 12, 0};  ///< 12 x 12 per piece, side by side; node -1: not used
  Eigen::Map<Eigen::MatrixXd> left{nullptr, 0, 0};     ///< 6 x rank per node of each group, one below the other
  Eigen::Map<Eigen::MatrixXd> right{nullptr, 0, 0};    ///< rank x 6 per node of each group, side by side
  /// rank x 3 rank per group, side by side: its rows, for the variables of the group before, its own, that behind.
  Eigen::Map<Eigen::MatrixXd> inner{nullptr, 0, 0};

  /// The size of `numbers`.
  static std::size_t size(const ForcePieces& pieces) {
    return 144 * pieces.pairs.size() +
           (12 * pieces.group_nodes() + 3 * pieces.rank * pieces.groups.size()) * pieces.rank;
  }
  /// A tangent whose matrices are in `numbers`.
  static PieceTangent in(double* numbers, const ForcePieces& pieces);
  /// Sets all matrices to zero, but the blocks of groups with themselves to identity.
  void set_zero();
  /// The dense matrix of the sum, 6n x 6n for n nodes of reach().
  Eigen::MatrixXd sum(const ForcePieces& pieces, std::size_t nodes) const;
};

/// The contribution of a force element to the balance of a step. For each node that it acts on, in their order:
/// residual rows {force, moment} and tangent columns {displacement, spin}, world axes.
struct ForceAction {
  Eigen::Map<Eigen::VectorXd> residual;  ///< output: minus the forces on the nodes
  Eigen::Map<Eigen::MatrixXd> tangent;   ///< output: its derivative by motions at the end; no rows: not needed
  PieceTangent pieces = {};              ///< output: the same in pieces, if the element has some; empty: not needed
  double dissipated = 0;                 ///< output: dissipated over the step [J]
  double work = 0;                       ///< output: work done on the mechanism from outside over the step [J]

  bool wants_tangent() const { return tangent.size() != 0 || pieces.blocks.size() != 0; }
};

/// A force element for small motions: springs and dampers that act on a few scalar measures of the poses of its nodes,
/// such as a length or a gap. Each measure has a tension; the forces on the nodes are rows^T tension.
struct ForceMeasures {
  Eigen::MatrixXd rows;       ///< per measure: derivative with respect to {displacement, spin} of the nodes, world axes
  Eigen::MatrixXd stiffness;  ///< derivative of tensions with respect to measures; positive semidefinite
};
/// The tensions of a force element's dampers.
struct DamperTensions {
  Eigen::VectorXd tension;
  Eigen::MatrixXd slope;  ///< derivative with respect to the measures' rates
};

/// A bound on motions before which a force element cannot act. If no node has moved farther than `way` and none has
/// turned by more than `angle`, at most by_way * way + by_turn * angle of `size` is used up.
struct ForceRoom {
  double size = 0;     ///< [m]; 0 or less: the element may act in the next step
  double by_way = 0;   ///< [-]
  double by_turn = 0;  ///< [m/rad]
};

/// A number of an element for output: the last part of its column's name, and its unit.
struct ForceOutput {
  const char* name;
  const char* unit;
};

/// The number of contact points of a contact, and the law of each.
struct TouchLaw {
  std::size_t points = 0;                                           ///< 0: the element is no contact
  double stiffness = 0;                                             ///< of shallow penetrations [N/m]
  double restitution = 1, friction = 0, spinning = 0, rolling = 0;  ///< the last two: couple per normal force [m]
  double restitution_of_fast_hits = restitution;                    ///< `restitution` is that of slow hits
};

/// Poses and velocities of all nodes for output.
struct ForceMotion {
  const State& state;
  const std::vector<Vector6>& velocities;  ///< {v, w}, world axes
  const double* memory;                    ///< the element's own part of State::force_memory
  const double* function_rates = nullptr;  ///< derivatives of functions() at the state's time [1/s]; for put_out()
};

/// A point at which an element's first link touches its second one (see ForceElement::links()) at an instant. The
/// normal force is that of the contact law; friction is that of the last step.
struct TouchingPoint {
  Vector3 position;                  ///< on the surface of the first, same origin as nodes' positions, world axes [m]
  Vector3 normal;                    ///< unit vector from the second to the first
  Vector3 push, friction;            ///< forces on the first, along the normal and across it [N]
  Vector3 couple = Vector3::Zero();  ///< on the first; resists spinning and rolling [N m]
  double gap = 0;                    ///< < 0: minus the penetration [m]
};
using TouchingPointTaker = std::function<void(const TouchingPoint&)>;
/// Takes the penetration of a contact point at both ends of a step [m], < 0 without contact, and its rate at the
/// beginning [m/s].
using PenetrationTaker = std::function<void(double begin, double end, double begin_rate)>;

/// A force element: it acts between points of the mechanism. It is constant, like the model that it belongs to; its
/// memory is part of the State. Steps, energies, equilibria, modes, linear models, sensitivities and results use only
/// this interface.
class ForceElement {
 public:
  /// `reach`: all nodes on which the element may ever act, each once. `functions`: see functions().
  ForceElement(std::string name, std::vector<int> reach, std::vector<int> functions = {})
      : name_(std::move(name)), reach_(std::move(reach)), functions_(std::move(functions)) {}
  virtual ~ForceElement() = default;

  /// Returns the tag of the element in the scene, such as "spring".
  virtual const char* kind() const = 0;
  /// Returns the element's name. An element without a name (empty) has no columns in results.
  const std::string& name() const { return name_; }
  /// The functions of time that the element uses: indices into Model::histories. The element does not evaluate them
  /// itself, since threads share it. It gets their values, and keeps those that it needs between steps in its memory.
  const std::vector<int>& functions() const { return functions_; }
  /// Whether the element uses FunctionStep::mean, which may take thousands of evaluations where a function has kinks.
  virtual bool uses_means() const { return false; }
  /// Returns a description for `flexarm check`, without kind, name and links. For elements that a
  /// ForceElementDescription has made.
  virtual std::string description() const { return {}; }
  /// Returns the names of the links between which the element acts. Empty for elements that a ForceElementDescription
  /// has made, since that knows them. All contacts of a pair of links have them in the same order.
  virtual std::vector<std::string> links() const { return {}; }

  // ---- the nodes on which the element acts
  const std::vector<int>& reach() const { return reach_; }
  /// Returns the largest number of nodes on which the element acts in one step. Less than the size of reach() if the
  /// nodes change from step to step.
  virtual int most_nodes() const { return static_cast<int>(reach_.size()); }
  /// Finds the nodes on which the element may act in a step that begins with `start`. Writes them to `nodes`, each
  /// once, and returns their number. If the duration is 0, these are all nodes of reach().
  virtual int find_nodes(const ForceStart& start, int* nodes) const {
    static_cast<void>(start);
    std::copy(reach_.begin(), reach_.end(), nodes);
    return static_cast<int>(reach_.size());
  }

  /// How the tangent is composed. An element with pieces acts on all nodes of reach() in every step, in their order.
  virtual const ForcePieces& pieces() const {
    static const ForcePieces none;
    return none;
  }

  /// Returns the room from the poses of `start` on. Until it is used up, find_nodes() finds no nodes and needs_halves()
  /// is false. The caller adds up the motion: for a step that begins, twice its duration times the speeds at its
  /// beginning; for a step that has been solved, its actual motion.
  virtual ForceRoom room(const ForceStart& start) const {
    static_cast<void>(start);
    return {};
  }

  // ---- forces and energy
  // `nodes`: as find_nodes() has written them.

  /// Makes a workspace for steps, with all memory that they need. Null: the element needs none.
  virtual std::unique_ptr<ForceWorkspace> make_workspace() const { return nullptr; }
  /// Begins a step, before all its evaluations: writes to the workspace what depends on the beginning only. The end is
  /// not known yet.
  virtual void begin(const ForceStep& step) const { static_cast<void>(step); }
  /// Computes the contribution to the balance of a step. Not called if the element acts on no nodes and has no memory.
  virtual void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const = 0;
  /// Whether a solved step is too long for the events in it, so that it must be repeated in halves. Also true if the
  /// element acts on no nodes in this step, but should.
  virtual bool needs_halves(const ForceStep& step, const int* nodes, int count) const {
    static_cast<void>(step), static_cast<void>(nodes), static_cast<void>(count);
    return false;
  }
  /// For a contact: calls `take` for each contact point that touches at either end of a solved step.
  virtual void put_penetrations(const ForceStep& step, const int* nodes, int count,
                                const PenetrationTaker& take) const {
    static_cast<void>(step), static_cast<void>(nodes), static_cast<void>(count), static_cast<void>(take);
  }
  /// Whether bodies hit each other in steps in which the element acts on nodes. Such steps may be halved more often.
  virtual bool hits() const { return false; }
  /// Returns the stored energy [J]. `memory`: the element's own part of State::force_memory.
  virtual double energy(const State& state, const double* memory) const = 0;
  virtual ForceMeasures measures(const State& state, const double* memory, const int* nodes) const = 0;
  /// Returns the tensions of the dampers. `rates`: of the measures, in their order.
  virtual DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const = 0;
  /// Returns how many numbers of State::force_memory belong to the element.
  virtual int memory_size() const { return 0; }
  /// Writes the numbers of the memory that are not zero in an initial state: the scene's, or one that a program has
  /// set. `functions`: values of functions() at the state's time.
  virtual void start(const State& state, const double* functions, double* memory) const {
    static_cast<void>(state), static_cast<void>(functions), static_cast<void>(memory);
  }
  /// Continues a memory after a program has changed the mechanism at an instant. `before` is the same element before
  /// the change: this one if positions were set, else the one of the model before an edit. Between both configurations
  /// no node turns by half a turn or more. `memory`: on input what start() writes for `state`; the default leaves it.
  virtual void carry(const ForceElement& before, const double* old_memory, const State& state, double* memory) const {
    static_cast<void>(before), static_cast<void>(old_memory), static_cast<void>(state), static_cast<void>(memory);
  }
  /// Whether any number of the element's memory is not zero.
  bool remembers(const double* memory) const {
    return std::any_of(memory, memory + memory_size(), [](double number) { return number != 0; });
  }

  /// Whether the element works with all schemes. False if it cannot give forces at the end of a step, which the Newmark
  /// family needs, and does not suit backward steps.
  virtual bool suits_all_schemes() const { return true; }
  /// Whether the element works with backward steps (of composition schemes). They would undo the dissipation of
  /// friction, and valves would let in or out what only the steps between need.
  virtual bool suits_backward_steps() const { return suits_all_schemes(); }

  // ---- output
  virtual std::vector<ForceOutput> outputs() const { return {}; }
  /// Appends the values of outputs().
  virtual void put_out(const ForceMotion& motion, std::vector<double>& values) const {
    static_cast<void>(motion), static_cast<void>(values);
  }
  /// Appends the points of the line along which the element acts, for pictures: same origin as nodes' positions, world
  /// axes [m]. Nothing if there is no such line.
  virtual void put_line(const ForceMotion& motion, std::vector<Vector3>& points) const {
    static_cast<void>(motion), static_cast<void>(points);
  }
  /// Returns the largest number of points that put_line() may append.
  virtual std::size_t most_line_points() const { return 0; }
  /// For a contact, which has two links(): calls `take` for each touching point. Returns the smallest gap between the
  /// two links [m], < 0 if they touch.
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
  std::vector<int> reach_, functions_;
};

using ForceElementList = std::vector<std::shared_ptr<const ForceElement>>;

/// Sets `nodes` to the nodes on which the element acts in a step that begins with `start`. Only the first call
/// allocates.
void find_nodes(const ForceElement& element, const ForceStart& start, std::vector<int>& nodes);
/// Returns where the memory of element `index` begins in State::force_memory.
std::size_t memory_begin(const ForceElementList& elements, std::size_t index);
/// Returns where the memory of each element begins in State::force_memory.
std::vector<const double*> memories_of(const ForceElementList& elements, const std::vector<double>& force_memory);
/// Returns the nodes on which each element acts in small motions about a state.
std::vector<std::vector<int>> nodes_of(const ForceElementList& elements, const State& state);

}  // namespace flexarm
