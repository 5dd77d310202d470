#pragma once
/// Views of the data of a tendon (internal to tendon.cpp and tendon_forces.cpp).

#include <vector>

#include "elements/tendon.h"

namespace flexarm {

class Tendon::Poses {
 public:
  explicit Poses(const std::vector<NodePose>& nodes) : nodes_(&nodes) {}
  explicit Poses(const State& state) : state_(&state) {}
  NodePose operator[](int node) const {
    if (node < 0) return {};
    return nodes_ ? (*nodes_)[node] : node_pose(state_->nodes[node]);
  }
  /// The point of a guide at an angle, world axes.
  Vector3 point(const GuidePlace& guide, double angle) const {
    const NodePose node = (*this)[guide.node];
    return node.position + node.rotation * guide.at(angle);
  }
  PiecePoses of(const TendonPiece& piece) const { return {(*this)[piece.first().node], (*this)[piece.second().node]}; }

 private:
  const std::vector<NodePose>* nodes_ = nullptr;
  const State* state_ = nullptr;
};

/// `Number`: double, or const double.
template <class Number>
struct Tendon::MemoryOf {
  Number* numbers;
  int parts;

  operator MemoryOf<const double>() const { return {numbers, parts}; }

  Number& function() const { return numbers[0]; }
  Number& rims_at_start(int part) const { return numbers[1 + part]; }
  Number& slip_rate(int part) const { return numbers[1 + parts + part]; }
  Number& touched(int guide) const { return numbers[1 + 2 * parts + 3 * guide]; }
  Number& comes(int guide) const { return numbers[2 + 2 * parts + 3 * guide]; }
  Number& goes(int guide) const { return numbers[3 + 2 * parts + 3 * guide]; }
  PieceState angles(int first, int second) const { return {0, goes(first), comes(second)}; }
};

struct Tendon::Span {
  TendonPiece piece;
  int first, second;  // guides
  int part;
  int first_node, second_node;    // indices into reach(); -1: world
  int first_place, second_place;  // indices into the nodes of the part; -1: world
  PieceWeights length, rest;      // its shares of the part's lengths
  bool winds;                     // whether `rest` is not zero
};

/// A span at both ends of a step.
struct Tendon::MovedSpan {
  Span span;
  PieceEnd begin, end;
};

/// Derivatives of the lengths of a part by {displacement, spin} of its nodes.
struct Tendon::PartForces {
  Eigen::VectorXd length, rest;

  void reset(std::size_t nodes) {
    const auto size = static_cast<Eigen::Index>(6 * nodes);
    length.setZero(size), rest.setZero(size);
  }
};

/// A step: what begin() finds, and memory for its evaluations.
struct Tendon::Workspace : ForceWorkspace {
  std::vector<MovedSpan> spans;            // along the line
  std::vector<TendonPartStep> part_steps;  // without slip
  std::vector<double> begin_rates;         // per part, without slip and function [m/s]
  TendonSlip slip;
  std::vector<double> ratios;
  std::vector<PartForces> directions, slopes;  // per part
  /// For a dense tangent: derivatives of the slips of all guides, of both lengths of a part, and of both its forces.
  struct Dense {
    Eigen::MatrixXd slips;
    Eigen::RowVectorXd by_length, by_rest, pull, push;
  } dense;
};

template <class Visit>
void Tendon::for_each_span(const Memory& memory, const Visit& visit) const {
  for (int part = 0; part < parts_; ++part) for_each_span(memory, part, visit);
}

template <class Visit>
void Tendon::for_each_span(const Memory& memory, int part, const Visit& visit) const {
  int first = part_ends_[part];
  for (int i = first + 1; i <= part_ends_[part + 1]; ++i) {
    if (memory.touched(i) == 0) continue;
    visit(span(first, i, part));
    first = i;
  }
}

}  // namespace flexarm
