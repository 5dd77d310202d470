#include <algorithm>
#include <limits>

#include "building/passes.h"
#include "building/spatial_inertia.h"
#include "joints/joint_kinematics.h"
#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

/// Inertia of a motion, relative to that of the coordinate alone with all others locked. Smaller values are round-off.
constexpr double kRoundOff = 1e-13;
/// The same, relative to the largest motion about the joint. Smaller values have no digits by which they could be
/// judged.
constexpr double kJudgeable = 1e-11;
/// Round-off of an inertia, relative to its terms: rotations, levers and sums are some sixty operations.
constexpr double kOperations = 64 * std::numeric_limits<double>::epsilon();

/// An inertia is small if it is less than this part of that with all other coordinates locked.
constexpr double kYields = 1e-6;

/// Factorises the joints' mass matrix from the leaves to the root (Featherstone). Parts outboard of a joint resist
/// motions inboard with the inertia that is left when the joint itself can move.
class Articulation {
 public:
  Articulation(const std::vector<int>& parents, const Model& model)
      : parents_(parents),
        model_(model),
        joint_of_(model.nodes.size(), -1),
        leads_(model.coordinates.size(), false),
        is_dependent_(model.coordinates.size(), false) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) joint_of_[model.joints[j].slave] = static_cast<int>(j);
    for (const Coordinate& coordinate : model.coordinates)
      if (coordinate.mimicked >= 0) leads_[coordinate.mimicked] = true;
  }

  bool has_loops() const {
    if (!model_.closures.empty()) return true;
    for (const JointMap& joint : model_.joints)
      if (joint.kind != JointMapKind::Slide && parents_[joint.slave] != joint.master) return true;
    return false;
  }

  void factorise() {
    do {
      begin();
      for (int i = static_cast<int>(articulated_.size()) - 1; i >= 0 && !blurs_; --i) {  // children before parents
        const int joint = joint_of_[i], parent = parents_[i];
        if (joint >= 0 && model_.joints[joint].kind != JointMapKind::Slide) yield(joint, i);
        if (parent >= 0) hand_on(i, parent);
      }
    } while (blurs_);
  }
  const std::vector<int>& dependent_coordinates() const { return dependent_; }
  const std::vector<double>& inertias() const { return inertias_; }

 private:
  /// The coordinate whose inertia is the smallest part of that with all others locked. What it moves, joints outboard
  /// of it can nearly move, too. Only joints with one coordinate are asked: a thin rod on a ball joint hardly resists
  /// its spin, but nothing else can spin it.
  struct Yielding {
    int coordinate = -1;
    double part = 1;
  };

  void begin() {
    articulated_.clear();
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
      articulated_.push_back(own_inertia(model_.inertias[i], model_.nodes[i].rotation));
    locked_ = articulated_;
    errors_.assign(articulated_.size(), SpatialInertia::Zero());
    most_yielding_.assign(articulated_.size(), {});
    inertias_.assign(model_.coordinates.size(), 0.0);
    blurs_ = false;
  }

  void hand_on(int node, int parent) {
    const Vector3 way = model_.nodes[node].position - model_.nodes[parent].position;
    articulated_[parent] += moved(articulated_[node], way);
    locked_[parent] += moved(locked_[node], way);
    errors_[parent] += moved(errors_[node], way);
    if (most_yielding_[node].part < most_yielding_[parent].part) most_yielding_[parent] = most_yielding_[node];
  }

  /// An inertia that is a small part has few digits, and takes the digits of all inertia inboard of it. If none are
  /// left there, the coordinate counts as one without inertia of its own: it is found with all others once more.
  void drop_blurring(int coordinate) {
    dependent_.push_back(coordinate);
    is_dependent_[coordinate] = blurs_ = true;
  }

  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

  void yield(int j, int node) {
    FoldMaps maps;
    variational_maps(model_.joints[j], joint_pose(model_.joints[j], model_.nodes, model_.initial_released[j]),
                     Vector6::Zero(), maps);
    std::vector<int> free = free_components(j, maps.right, node);
    while (!free.empty()) {
      Columns columns(6, free.size());
      for (std::size_t k = 0; k < free.size(); ++k) columns.col(k) = maps.right.col(free[k]);
      const int dependent = dependent_of(columns, rotors(j, free), node);
      if (dependent < 0) {
        for (const int component : free) yield_along(maps.right.col(component), j, component, node);
        return;
      }
      dependent_.push_back(model_.first_coordinate[j] + free[dependent]);
      is_dependent_[dependent_.back()] = true;
      free.erase(free.begin() + dependent);
    }
  }

  /// Reduces the inertia at a node by the part that this coordinate's own motion takes up, with the inertia of its
  /// rotor.
  void yield_along(const Vector6& column, int j, int component, int node) {
    const int coordinate = model_.first_coordinate[j] + component;
    const Vector6 force = articulated_[node] * column;
    const double resisting = column.dot(force) + rotor(j, component);
    if (model_.joints[j].kind == JointMapKind::Scalar) {
      const double part = resisting / (column.dot(locked_[node] * column) + rotor(j, component));
      errors_[node] += kOperations * articulated_[node];
      const double error = column.dot(errors_[node] * column);
      if (resisting <= error)
        return drop_blurring(most_yielding_[node].part < kYields ? most_yielding_[node].coordinate : coordinate);
      errors_[node] += force * force.transpose() * (error / (resisting * resisting));
      if (part < most_yielding_[node].part) most_yielding_[node] = {coordinate, part};
    }
    articulated_[node] -= force * force.transpose() / resisting;
    inertias_[coordinate] = resisting;
  }

  /// Inertia of the rotor that turns with a component of a joint.
  double rotor(int j, int component) const {
    return armature(model_, model_.coordinates[model_.first_coordinate[j] + component]);
  }
  Square rotors(int j, const std::vector<int>& free) const {
    Square out = Square::Zero(free.size(), free.size());
    for (std::size_t k = 0; k < free.size(); ++k) out(k, k) = rotor(j, free[k]);
    return out;
  }

  /// The components that are free, and that have inertia of their own.
  std::vector<int> free_components(int j, const Columns& columns, int node) const {
    const double mass = locked_[node].topLeftCorner<3, 3>().trace(),
                 inertia = locked_[node].bottomRightCorner<3, 3>().trace();
    std::vector<int> free;
    for (int k = 0; k < columns.cols(); ++k) {
      const int index = model_.first_coordinate[j] + k;
      const Coordinate& coordinate = model_.coordinates[index];
      const Vector6 column = columns.col(k);
      const double terms = mass * column.head<3>().squaredNorm() + inertia * column.tail<3>().squaredNorm();
      const bool is_free = coordinate.motion < 0 && coordinate.mimicked < 0 && !leads_[index] && !is_dependent_[index];
      if (is_free && column.dot(locked_[node] * column) > kJudgeable * terms) free.push_back(k);
    }
    return free;
  }

  /// Where joints further outboard can move, some motion of this joint may have no inertia. Returns the column that
  /// moves most in it, or -1 if there is no such motion.
  int dependent_of(const Columns& columns, const Square& rotors, int node) const {
    const Square locked = Square(columns.transpose() * locked_[node] * columns) + rotors;
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scale = locked.diagonal().cwiseSqrt().cwiseInverse();
    const auto [inertias, directions] = symmetric_eigenpairs(scale.asDiagonal() * locked * scale.asDiagonal());
    const auto count = (inertias.array() > kJudgeable).count();
    // Motions that have equal inertia with other joints locked.
    const Square motions =
        scale.asDiagonal() * directions.rightCols(count) * inertias.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
    const Square yielding = Square(columns.transpose() * articulated_[node] * columns) + rotors;
    const SymmetricEigenpairs pairs = symmetric_eigenpairs(motions.transpose() * yielding * motions);
    if (pairs.values[0] > kRoundOff) return -1;
    Eigen::Index most = 0;
    scale.cwiseInverse().cwiseProduct(motions * pairs.vectors.col(0)).cwiseAbs().maxCoeff(&most);
    return static_cast<int>(most);
  }

  const std::vector<int>& parents_;
  const Model& model_;
  std::vector<int> joint_of_;                         // per node: joint that moves it, or -1
  std::vector<bool> leads_;                           // per coordinate: whether others follow it
  std::vector<bool> is_dependent_;                    // per coordinate
  std::vector<SpatialInertia> articulated_, locked_;  // per node: all outboard, joints movable or locked
  std::vector<SpatialInertia> errors_;                // per node: bound of the round-off of `articulated_`
  std::vector<Yielding> most_yielding_;               // per node: outboard
  bool blurs_ = false;                                // round-off of the last one in `dependent_` hides other inertia
  std::vector<int> dependent_;
  std::vector<double> inertias_;  // per coordinate
};

}  // namespace

std::vector<int> coordinates_without_own_inertia(const std::vector<int>& parents, const Model& model) {
  Articulation articulation(parents, model);
  if (!articulation.has_loops()) articulation.factorise();
  return articulation.dependent_coordinates();
}

std::vector<double> articulated_inertias(const std::vector<int>& parents, const Model& model) {
  Articulation articulation(parents, model);
  if (!articulation.has_loops()) articulation.factorise();
  return articulation.inertias();
}

}  // namespace flexarm
