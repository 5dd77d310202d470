#include <algorithm>

#include "building/passes.h"
#include "building/tree_inertia.h"
#include "math/dense_eigenpairs.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// A motion has no inertia if it has less than this part of that of the heaviest motion of its loops.
constexpr double kNoInertia = 1e-13;
/// A coordinate takes part in a motion if it has more than this part of the largest one.
constexpr double kTakesPart = 1e-6;

class LoopInertias {
 public:
  LoopInertias(const std::vector<int>& parents, const Model& model)
      : model_(model), tree_(parents, model), followers_(model.coordinates.size()), out_(model.coordinates.size()) {
    for (std::size_t i = 0; i < model.coordinates.size(); ++i)
      if (model.coordinates[i].mimicked >= 0) followers_[model.coordinates[i].mimicked].push_back(static_cast<int>(i));
  }

  std::vector<InLoops> find(const std::vector<bool>& is_asked) {
    for (const ConstraintGroup& group : independent_groups(jacobian()))
      if (std::any_of(group.columns.begin(), group.columns.end(), [&](int column) { return is_asked[column]; }))
        add(group);
    return std::move(out_);
  }

 private:
  double scale(int coordinate) const { return coordinate_scale(model_, model_.coordinates[coordinate]); }
  double ratio(int follower) const {
    return follower_ratio(model_, model_.coordinates[follower], model_.initial_released);
  }

  /// Scaled constraints by scaled coordinates. Columns of prescribed and following coordinates are empty.
  ConstraintRows jacobian() const {
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0;
    for_each_constraint(model_, Constraints::WithMultipliers, [&](const auto& closure, const auto& constraint) {
      const ClosureRows own = closure_rows(closure, constraint, closure_poses(closure, model_.nodes));
      const double unit = 1 / constraint_scale(model_, constraint);
      add_way(closure.child, unit * own.child, row, entries);
      if (closure.parent >= 0) add_way(closure.parent, unit * own.parent, row, entries);
      ++row;
    });
    ConstraintRows out(row, static_cast<Eigen::Index>(model_.coordinates.size()));
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  /// Adds the derivatives of a constraint by the coordinates on the way from a node to the root. `by_node`: by the
  /// node's motion.
  void add_way(int end, const Vector6& by_node, int row, std::vector<Eigen::Triplet<double>>& entries) const {
    tree_.for_each_way_to_move(end, [&](int coordinate, const Vector6& motion) {
      double value = by_node.dot(motion);
      if (model_.coordinates[coordinate].mimicked >= 0) {
        value *= ratio(coordinate);
        coordinate = model_.coordinates[coordinate].mimicked;
      }
      if (model_.coordinates[coordinate].motion < 0) entries.emplace_back(row, coordinate, value * scale(coordinate));
    });
  }

  /// The motions of the unknowns of a group, and of the coordinates that follow them.
  std::vector<TreeMotion> motions_of(const ConstraintGroup& group) const {
    std::vector<TreeMotion> motions;
    for (std::size_t u = 0; u < group.columns.size(); ++u) {
      const int unknown = group.columns[u];
      const auto add = [&](int coordinate, double factor) {
        const Coordinate& own = model_.coordinates[coordinate];
        const int slave = model_.joints[own.joint].slave;
        if (tree_.joint_of(slave) == own.joint)
          motions.push_back({static_cast<int>(u), slave, factor * tree_.columns_of(own.joint).col(own.component)});
      };
      add(unknown, scale(unknown));
      for (const int follower : followers_[unknown]) add(follower, scale(unknown) * ratio(follower));
    }
    return motions;
  }

  Eigen::MatrixXd mass_matrix(const ConstraintGroup& group) const {
    const auto size = static_cast<Eigen::Index>(group.columns.size());
    Eigen::MatrixXd mass = tree_.mass_matrix(motions_of(group), size);
    for (Eigen::Index u = 0; u < size; ++u) {
      const int coordinate = group.columns[static_cast<std::size_t>(u)];
      mass(u, u) += armature(model_, model_.coordinates[coordinate]) * scale(coordinate) * scale(coordinate);
    }
    return mass;
  }

  void add(const ConstraintGroup& group) {
    const Eigen::Index size = group.block.cols(),
                       free = size - static_cast<Eigen::Index>(independent_rows(group.block, kIndependent).size());
    for (const int column : group.columns) out_[column].is_determined = true;
    if (free == 0) return;  // prescribed motions determine everything
    const Eigen::MatrixXd motions =
        symmetric_eigenpairs(group.block.transpose() * group.block).vectors.leftCols(free);  // loops stay closed
    const SymmetricEigenpairs pairs = symmetric_eigenpairs(motions.transpose() * mass_matrix(group) * motions);
    const Eigen::MatrixXd ways = motions * pairs.vectors;
    Eigen::VectorXd yielding = Eigen::VectorXd::Zero(size), massless = Eigen::VectorXd::Zero(size);
    for (Eigen::Index k = 0; k < free; ++k)
      if (pairs.values[k] > kNoInertia * pairs.values[free - 1])
        yielding += ways.col(k).cwiseAbs2() / pairs.values[k];
      else
        massless = massless.cwiseMax(ways.col(k).cwiseAbs());
    for (Eigen::Index u = 0; u < size; ++u) {
      const int coordinate = group.columns[static_cast<std::size_t>(u)];
      const double unit = scale(coordinate);
      out_[coordinate].is_determined = massless[u] <= kTakesPart;
      const bool moves = ways.row(u).lpNorm<Eigen::Infinity>() > kTakesPart;
      if (moves && yielding[u] > 0) out_[coordinate].inertia = 1 / (unit * unit * yielding[u]);
    }
  }

  const Model& model_;
  TreeInertia tree_;
  std::vector<std::vector<int>> followers_;  // per coordinate
  std::vector<InLoops> out_;
};

}  // namespace

std::vector<InLoops> loop_inertias(const std::vector<int>& parents, const Model& model,
                                   const std::vector<bool>& is_asked) {
  if (model.closures.empty()) return std::vector<InLoops>(model.coordinates.size());
  return LoopInertias(parents, model).find(is_asked);
}

}  // namespace flexarm
