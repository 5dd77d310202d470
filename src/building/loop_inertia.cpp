#include <algorithm>

#include "building/passes.h"
#include "building/spatial_inertia.h"
#include "joints/kinematics.h"
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
      : parents_(parents),
        model_(model),
        joint_of_(model.nodes.size(), -1),
        followers_(model.coordinates.size()),
        out_(model.coordinates.size()) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointMap& joint = model.joints[j];
      // Sliders count as locked, and so do joints that close loops at the ends of beams.
      if (joint.kind != JointMapKind::Slide && parents[joint.slave] == joint.master)
        joint_of_[joint.slave] = static_cast<int>(j);
    }
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
  /// One of the coordinates that move with an unknown of a group: that unknown, or one that follows it.
  struct Member {
    int unknown;     // index in the group
    int node;        // that it moves
    Vector6 motion;  // of that node {v, w}, world axes, per unit of the scaled unknown
  };

  /// The unit of an unknown, so that all of them have the same size.
  double scale(int coordinate) const {
    return is_rotation(model_, model_.coordinates[coordinate]) ? 1.0 : model_.length_scale;
  }
  double ratio(int follower) const {
    const Coordinate& coordinate = model_.coordinates[follower];
    const int master = model_.coordinates[coordinate.mimicked].joint;
    return coordinate.mimic.derivative(model_.initial_released[master].displacement[0]);
  }
  /// Motion of a joint's slave {v, w} per unit of each coordinate.
  ReleasedColumns columns_of(int joint) const {
    const JointMap& map = model_.joints[joint];
    FoldMaps maps;
    variational_maps(map, joint_pose(map, model_.nodes, model_.initial_released[joint]), Vector6::Zero(), maps);
    return maps.right;
  }
  Vector6 seen_at(Vector6 motion, int from, int to) const {
    motion.head<3>() += Vector3(motion.tail<3>()).cross(model_.nodes[to].position - model_.nodes[from].position);
    return motion;
  }

  /// Scaled constraints by scaled coordinates. Columns of prescribed and following coordinates are empty.
  ConstraintRows jacobian() const {
    std::vector<Eigen::Triplet<double>> entries;
    int row = 0;
    for (const LoopClosure& closure : model_.closures)
      for (const ClosureConstraint& constraint : closure.constraints) {
        const NodePose parent = closure.parent < 0 ? NodePose() : model_.nodes[closure.parent];
        const ClosureRows own = closure_rows(closure, constraint, {parent, model_.nodes[closure.child]});
        const double unit = constraint.kind == ClosureConstraint::Kind::Gap ? 1 / model_.length_scale : 1;
        add_way(closure.child, unit * own.child, row, entries);
        if (closure.parent >= 0) add_way(closure.parent, unit * own.parent, row, entries);
        ++row;
      }
    ConstraintRows out(row, static_cast<Eigen::Index>(model_.coordinates.size()));
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  /// Adds the derivatives of a constraint by the coordinates on the way from a node to the root. `by_node`: by the
  /// node's motion.
  void add_way(int end, const Vector6& by_node, int row, std::vector<Eigen::Triplet<double>>& entries) const {
    for (int node = end; node >= 0; node = parents_[node]) {
      if (joint_of_[node] < 0) continue;
      const ReleasedColumns columns = columns_of(joint_of_[node]);
      for (Eigen::Index k = 0; k < columns.cols(); ++k) {
        int coordinate = model_.first_coordinate[joint_of_[node]] + static_cast<int>(k);
        double value = by_node.dot(seen_at(columns.col(k), node, end));
        if (model_.coordinates[coordinate].mimicked >= 0) {
          value *= ratio(coordinate);
          coordinate = model_.coordinates[coordinate].mimicked;
        }
        if (model_.coordinates[coordinate].motion < 0) entries.emplace_back(row, coordinate, value * scale(coordinate));
      }
    }
  }

  std::vector<Member> members_of(const ConstraintGroup& group) const {
    std::vector<Member> members;
    for (std::size_t u = 0; u < group.columns.size(); ++u) {
      const int unknown = group.columns[u];
      const auto add = [&](int coordinate, double factor) {
        const Coordinate& own = model_.coordinates[coordinate];
        const int slave = model_.joints[own.joint].slave;
        if (joint_of_[slave] == own.joint)
          members.push_back({static_cast<int>(u), slave, factor * columns_of(own.joint).col(own.component)});
      };
      add(unknown, scale(unknown));
      for (const int follower : followers_[unknown]) add(follower, scale(unknown) * ratio(follower));
    }
    return members;
  }

  bool hangs_on(int node, int inboard) const {
    while (node > inboard) node = parents_[node];  // parents come before their children
    return node == inboard;
  }

  Eigen::MatrixXd mass_matrix(const ConstraintGroup& group) {
    sum_inertias();
    const auto size = static_cast<Eigen::Index>(group.columns.size());
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(size, size);
    const std::vector<Member> members = members_of(group);
    for (const Member& outer : members) {
      const Vector6 momentum = outboard_[outer.node] * outer.motion;
      for (const Member& inner : members) {
        if (!hangs_on(outer.node, inner.node)) continue;
        const double entry = momentum.dot(seen_at(inner.motion, inner.node, outer.node));
        mass(outer.unknown, inner.unknown) += entry;
        if (inner.node != outer.node) mass(inner.unknown, outer.unknown) += entry;
      }
    }
    for (Eigen::Index u = 0; u < size; ++u) {
      const int coordinate = group.columns[static_cast<std::size_t>(u)];
      mass(u, u) += armature(model_, model_.coordinates[coordinate]) * scale(coordinate) * scale(coordinate);
    }
    return mass;
  }

  /// Inertia of all that hangs on each node, about the node.
  void sum_inertias() {
    if (!outboard_.empty()) return;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
      outboard_.push_back(own_inertia(model_.inertias[i], model_.nodes[i].rotation));
    for (std::size_t i = outboard_.size(); i-- > 0;)
      if (const int parent = parents_[i]; parent >= 0)
        outboard_[parent] += moved(outboard_[i], model_.nodes[i].position - model_.nodes[parent].position);
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

  const std::vector<int>& parents_;
  const Model& model_;
  std::vector<int> joint_of_;                // per node: joint of the tree that moves it, or -1
  std::vector<std::vector<int>> followers_;  // per coordinate
  std::vector<SpatialInertia> outboard_;     // per node
  std::vector<InLoops> out_;
};

}  // namespace

std::vector<InLoops> loop_inertias(const std::vector<int>& parents, const Model& model,
                                   const std::vector<bool>& is_asked) {
  if (model.closures.empty()) return std::vector<InLoops>(model.coordinates.size());
  return LoopInertias(parents, model).find(is_asked);
}

}  // namespace flexarm
