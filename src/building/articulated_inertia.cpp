#include "building/model_builder.h"
#include "building/passes.h"
#include "building/tree_inertia.h"
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
/// motions inboard with the inertia that is left when the joint itself can move. Coordinates are released one by one,
/// since each pivot is judged; ArticulatedBodies (joints), which steps use, releases whole joints that have inertia.
class Articulation {
 public:
  Articulation(const std::vector<int>& parents, const Model& model)
      : parents_(parents),
        model_(model),
        tree_(parents, model),
        leads_(model.coordinates.size(), false),
        inertias_(model.coordinates.size(), 0.0) {
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
    tree_.for_each_inertia([&](int node, SpatialInertia& inertia) {
      if (const int joint = tree_.joint_of(node); joint >= 0) yield(joint, node, inertia);
    });
  }
  const std::vector<int>& dependent_coordinates() const { return dependent_; }
  const std::vector<double>& inertias() const { return inertias_; }

  /// After factorise(): see coordinates_of_hidden_inertia().
  std::vector<int> hidden_motion() const {
    std::vector<TreeMotion> motions;
    std::vector<int> coordinates;
    for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
      const int j = tree_.joint_of(i);
      if (j < 0) continue;
      const ReleasedColumns& columns = tree_.columns_of(j);
      for (const int k : free_components(j, columns, i)) {
        motions.push_back({static_cast<int>(coordinates.size()), i, columns.col(k)});
        coordinates.push_back(model_.first_coordinate[j] + k);
      }
    }
    const std::size_t count = coordinates.size();
    if (count < 2 || count > kMostAsked) return {};
    Eigen::MatrixXd mass = tree_.mass_matrix(motions, static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) mass(i, i) += armature(model_, model_.coordinates[coordinates[i]]);
    const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
    const auto [inertias, ways] = symmetric_eigenpairs(scale.asDiagonal() * mass * scale.asDiagonal());
    if (inertias[0] > kHidden) return {};
    const Eigen::VectorXd parts = ways.col(0).cwiseAbs();
    std::vector<int> hidden;
    for (std::size_t i = 0; i < count; ++i)
      if (parts[static_cast<Eigen::Index>(i)] >= kTakesPart * parts.maxCoeff()) hidden.push_back(coordinates[i]);
    return hidden;
  }

 private:
  /// Takes from the inertia at a node what it does not resist where its joint can move.
  void yield(int j, int node, SpatialInertia& inertia) {
    const ReleasedColumns& all = tree_.columns_of(j);
    std::vector<int> free = free_components(j, all, node);
    while (!free.empty()) {
      ReleasedColumns columns(6, free.size());
      for (std::size_t k = 0; k < free.size(); ++k) columns.col(k) = all.col(free[k]);
      const int dependent = dependent_of(columns, rotors(j, free), node, inertia);
      if (dependent < 0) {
        for (const int component : free) yield_along(all.col(component), j, component, inertia);
        return;
      }
      dependent_.push_back(model_.first_coordinate[j] + free[dependent]);
      free.erase(free.begin() + dependent);
    }
  }

  /// Reduces an inertia by the part that this coordinate's own motion takes up, with the inertia of its rotor.
  void yield_along(const Vector6& column, int j, int component, SpatialInertia& inertia) {
    const Vector6 force = inertia * column;
    const double resisting = column.dot(force) + rotor(j, component);
    inertia -= force * force.transpose() / resisting;
    inertias_[model_.first_coordinate[j] + component] = resisting;
  }

  /// Inertia of the rotor that turns with a component of a joint.
  double rotor(int j, int component) const {
    return armature(model_, model_.coordinates[model_.first_coordinate[j] + component]);
  }
  ReleasedSquare rotors(int j, const std::vector<int>& free) const {
    ReleasedSquare out = ReleasedSquare::Zero(free.size(), free.size());
    for (std::size_t k = 0; k < free.size(); ++k) out(k, k) = rotor(j, free[k]);
    return out;
  }

  /// The components that are free, and that have inertia of their own.
  std::vector<int> free_components(int j, const ReleasedColumns& columns, int node) const {
    const double mass = tree_.outboard(node).topLeftCorner<3, 3>().trace(),
                 inertia = tree_.outboard(node).bottomRightCorner<3, 3>().trace();
    std::vector<int> free;
    for (int k = 0; k < columns.cols(); ++k) {
      const int index = model_.first_coordinate[j] + k;
      const Coordinate& coordinate = model_.coordinates[index];
      const Vector6 column = columns.col(k);
      const double terms = mass * column.head<3>().squaredNorm() + inertia * column.tail<3>().squaredNorm();
      const bool is_free = coordinate.motion < 0 && coordinate.mimicked < 0 && !leads_[index];
      if (is_free && column.dot(tree_.outboard(node) * column) > kJudgeable * terms) free.push_back(k);
    }
    return free;
  }

  /// Where joints further outboard can move, some motion of this joint may have no inertia. Returns the column that
  /// moves most in it, or -1 if there is no such motion.
  /// `yielding_inertia`: of all outboard, if its joints can move.
  int dependent_of(const ReleasedColumns& columns, const ReleasedSquare& rotors, int node,
                   const SpatialInertia& yielding_inertia) const {
    const ReleasedSquare locked = ReleasedSquare(columns.transpose() * tree_.outboard(node) * columns) + rotors;
    const ReleasedVector scale = locked.diagonal().cwiseSqrt().cwiseInverse();
    const auto [inertias, directions] = symmetric_eigenpairs(scale.asDiagonal() * locked * scale.asDiagonal());
    const auto count = (inertias.array() > kJudgeable).count();
    // Motions that have equal inertia with other joints locked.
    const ReleasedSquare motions =
        scale.asDiagonal() * directions.rightCols(count) * inertias.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
    const ReleasedSquare yielding = ReleasedSquare(columns.transpose() * yielding_inertia * columns) + rotors;
    const SymmetricEigenpairs pairs = symmetric_eigenpairs(motions.transpose() * yielding * motions);
    if (pairs.values[0] > kRoundOff) return -1;
    Eigen::Index most = 0;
    scale.cwiseInverse().cwiseProduct(motions * pairs.vectors.col(0)).cwiseAbs().maxCoeff(&most);
    return static_cast<int>(most);
  }

  const std::vector<int>& parents_;
  const Model& model_;
  TreeInertia tree_;
  std::vector<bool> leads_;  // per coordinate: whether others follow it
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
