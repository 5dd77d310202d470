#include "building/model_builder.h"
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
/// The same for a motion of several coordinates, relative to their own inertias. Rotations and levers leave as much
/// round-off in it.
constexpr double kHidden = 1e-12;
/// Larger mass matrices are not asked: a chain of n equal links has a motion with some n^-4 of the inertia of one
/// joint.
constexpr std::size_t kMostAsked = 100;
/// The coordinates that a motion is said to be of have at least this part of the largest motion, each relative to its
/// own inertia.
constexpr double kTakesPart = 0.1;

/// Factorises the joints' mass matrix from the leaves to the root (Featherstone). Parts outboard of a joint resist
/// motions inboard with the inertia that is left when the joint itself can move.
class Articulation {
 public:
  Articulation(const std::vector<int>& parents, const Model& model)
      : parents_(parents),
        model_(model),
        joint_of_(model.nodes.size(), -1),
        leads_(model.coordinates.size(), false),
        inertias_(model.coordinates.size(), 0.0) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) joint_of_[model.joints[j].slave] = static_cast<int>(j);
    for (const Coordinate& coordinate : model.coordinates)
      if (coordinate.mimicked >= 0) leads_[coordinate.mimicked] = true;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      articulated_.push_back(own_inertia(model.inertias[i], model.nodes[i].rotation));
    locked_ = articulated_;
  }

  bool has_loops() const {
    if (!model_.closures.empty()) return true;
    for (const JointMap& joint : model_.joints)
      if (joint.kind != JointMapKind::Slide && parents_[joint.slave] != joint.master) return true;
    return false;
  }

  void factorise() {
    for (int i = static_cast<int>(articulated_.size()) - 1; i >= 0; --i) {  // parents come before their children
      const int joint = joint_of_[i], parent = parents_[i];
      if (joint >= 0 && model_.joints[joint].kind != JointMapKind::Slide) yield(joint, i);
      if (parent < 0) continue;
      const Vector3 way = model_.nodes[i].position - model_.nodes[parent].position;
      articulated_[parent] += moved(articulated_[i], way);
      locked_[parent] += moved(locked_[i], way);
    }
  }
  const std::vector<int>& dependent_coordinates() const { return dependent_; }
  const std::vector<double>& inertias() const { return inertias_; }

  /// After factorise(): see coordinates_of_hidden_inertia().
  std::vector<int> hidden_motion() const {
    const std::vector<FreeColumn> columns = free_columns();
    const std::size_t count = columns.size();
    if (count < 2 || count > kMostAsked) return {};
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t b = 0; b < count; ++b) {
      const Vector6 force = locked_[columns[b].node] * columns[b].motion;
      std::vector<bool> carries(model_.nodes.size(), false);
      for (int node = columns[b].node; node >= 0; node = parents_[node]) carries[node] = true;
      for (std::size_t a = 0; a < count; ++a)
        if (carries[columns[a].node] && (columns[a].node != columns[b].node || a <= b))
          mass(a, b) = mass(b, a) = at(columns[b].node, columns[a]).dot(force);
      mass(b, b) += columns[b].rotor;
    }
    const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
    const auto [inertias, motions] = symmetric_eigenpairs(scale.asDiagonal() * mass * scale.asDiagonal());
    if (inertias[0] > kHidden) return {};
    const Eigen::VectorXd parts = motions.col(0).cwiseAbs();
    std::vector<int> coordinates;
    for (std::size_t i = 0; i < count; ++i)
      if (parts[static_cast<Eigen::Index>(i)] >= kTakesPart * parts.maxCoeff())
        coordinates.push_back(columns[i].coordinate);
    return coordinates;
  }

 private:
  /// The motion {displacement, spin} of a joint's slave, and of all that it carries, per unit of a free coordinate.
  struct FreeColumn {
    int coordinate, node;
    Vector6 motion;
    double rotor;
  };

  std::vector<FreeColumn> free_columns() const {
    std::vector<FreeColumn> out;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      const int j = joint_of_[i];
      if (j < 0 || model_.joints[j].kind == JointMapKind::Slide) continue;
      const Columns columns = columns_of(j);
      for (const int k : free_components(j, columns, static_cast<int>(i)))
        out.push_back({model_.first_coordinate[j] + k, static_cast<int>(i), columns.col(k), rotor(j, k)});
    }
    return out;
  }

  /// The motion of a node that the column's node carries.
  Vector6 at(int node, const FreeColumn& column) const {
    Vector6 motion = column.motion;
    const Vector3 way = model_.nodes[node].position - model_.nodes[column.node].position;
    motion.head<3>() += column.motion.tail<3>().cross(way);
    return motion;
  }

  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

  Columns columns_of(int j) const {
    FoldMaps maps;
    variational_maps(model_.joints[j], joint_pose(model_.joints[j], model_.nodes, model_.initial_released[j]),
                     Vector6::Zero(), maps);
    return maps.right;
  }

  void yield(int j, int node) {
    const Columns all = columns_of(j);
    std::vector<int> free = free_components(j, all, node);
    while (!free.empty()) {
      Columns columns(6, free.size());
      for (std::size_t k = 0; k < free.size(); ++k) columns.col(k) = all.col(free[k]);
      const int dependent = dependent_of(columns, rotors(j, free), node);
      if (dependent < 0) {
        for (const int component : free) yield_along(all.col(component), j, component, node);
        return;
      }
      dependent_.push_back(model_.first_coordinate[j] + free[dependent]);
      free.erase(free.begin() + dependent);
    }
  }

  /// Reduces the inertia at a node by the part that this coordinate's own motion takes up, with the inertia of its
  /// rotor.
  void yield_along(const Vector6& column, int j, int component, int node) {
    const Vector6 force = articulated_[node] * column;
    const double resisting = column.dot(force) + rotor(j, component);
    articulated_[node] -= force * force.transpose() / resisting;
    inertias_[model_.first_coordinate[j] + component] = resisting;
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
      const bool is_free = coordinate.motion < 0 && coordinate.mimicked < 0 && !leads_[index];
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
  std::vector<SpatialInertia> articulated_, locked_;  // per node: all outboard, joints movable or locked
  std::vector<int> dependent_;
  std::vector<double> inertias_;  // per coordinate
};

}  // namespace

std::vector<int> coordinates_without_own_inertia(const std::vector<int>& parents, const Model& model) {
  Articulation articulation(parents, model);
  if (!articulation.has_loops()) articulation.factorise();
  return articulation.dependent_coordinates();
}

std::vector<int> coordinates_of_hidden_inertia(const Model& model) {
  Articulation articulation(model.node_parents, model);
  if (articulation.has_loops()) return {};
  articulation.factorise();
  return articulation.hidden_motion();
}

std::vector<double> articulated_inertias(const std::vector<int>& parents, const Model& model) {
  Articulation articulation(parents, model);
  if (!articulation.has_loops()) articulation.factorise();
  return articulation.inertias();
}

}  // namespace flexarm
