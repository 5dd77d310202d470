// The derivative of a contact's forces by the motion of its nodes. (docs/notes/contact.md 1.1, 1.2)
#include "contact/contact_step.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Degrees of freedom of an element with the largest possible number of nodes.
constexpr int kMostColumns = 6 * (ContactStation::kMostNodes + 1);
template <int kColumns>
using Rows3 =
    Eigen::Matrix<double, 3, kColumns, Eigen::ColMajor, 3, kColumns == Eigen::Dynamic ? kMostColumns : kColumns>;

template <int kColumns>
using Row =
    Eigen::Matrix<double, 1, kColumns, Eigen::RowMajor, 1, kColumns == Eigen::Dynamic ? kMostColumns : kColumns>;

}  // namespace

/// Derivatives with respect to {displacement, spin} of all nodes.
template <int kColumns>
struct ContactElement::Rows {
  Rows3<kColumns> way, turn;      // of the station's position at the end and its rotation, relative to the base
  Rows3<kColumns> seen, turned;   // of both in the shapes' frame
  Rows3<kColumns> spin;           // of the spin of the only node relative to the base
  Rows3<kColumns> along;          // of the way of the point that touches along a segment, world axes
  Rows3<kColumns> force, couple;  // on the station, world axes
};

template <int kColumns>
void ContactElement::add_tilt(const Frames& frames, const Tilt& tilt, const PointAction& local,
                              Rows<kColumns>& rows) const {
  const Rows3<kColumns> offset = tilt.by_spin * (frames.base_end.rotation.transpose() * rows.spin);
  rows.force += frames.axes * (local.by_offset.template topRows<3>() * offset);
  rows.couple += frames.axes * (local.by_offset.template bottomRows<3>() * offset);
  const Vector3 axis = tilt.axis.cross(tilt.normal);
  const Eigen::RowVector3d push = -local.push_slope * local.normal.transpose();
  rows.couple += tilt.lever.value * axis * (push * (rows.seen + offset)) +
                 local.push * tilt.lever.slope * axis * (tilt.cosine_by_spin() * rows.spin);
  const double scale = frames.weight * local.push * tilt.lever.value;
  const int base = 6 * moving_nodes();
  if (base > 0) rows.couple.template middleCols<3>(3) += scale * hat(tilt.normal) * hat(tilt.end_axis);
  if (surface_.node >= 0) rows.couple.template middleCols<3>(base + 3) -= scale * hat(tilt.axis) * hat(tilt.end_normal);
}

template <int kColumns>
ContactElement::Rows<kColumns> ContactElement::rows_of(const ContactStation& station, const Frames& frames,
                                                       const Placed& placed) const {
  const int count = moving_nodes(), base = 6 * count;
  const bool has_base = surface_.node >= 0;
  const Matrix3& end_axes = frames.base_end.rotation;
  Rows<kColumns> rows;
  rows.way = Rows3<kColumns>::Zero(3, base + 6 * has_base);
  rows.turn = rows.way;
  for (int i = 0; i < count; ++i) {
    rows.way.template middleCols<3>(6 * i).diagonal().setConstant(station.weights[i]);
    rows.turn.template middleCols<3>(6 * i + 3) = station.weights[i] * cayley::inverse_tangent(frames.turns[i]);
  }
  if (count == 1) rows.way.template middleCols<3>(3) = -hat(placed.end_arm);
  if (has_base) {
    rows.way.template middleCols<3>(base).diagonal().setConstant(-1);
    rows.turn.template middleCols<3>(base + 3) = -cayley::inverse_tangent(frames.base_turn);
  }
  rows.seen = end_axes.transpose() * rows.way;
  rows.turned = frames.axes.transpose() * rows.turn;
  if (has_base) {
    rows.seen.template middleCols<3>(base + 3) = end_axes.transpose() * hat(placed.end_base_arm);
    rows.turned.template middleCols<3>(base + 3) += frames.weight * end_axes.transpose() * hat(placed.turn);
  }
  return rows;
}

/// Adds that the point that touches moves along a segment, in an equilibrium also at the beginning, from which friction
/// counts. Without it, forces change by the excess alone.
template <int kColumns>
void ContactElement::add_slide(const Frames& frames, const Slide& slide, const PointAction& local,
                               Rows<kColumns>& rows) const {
  const Matrix3& end_axes = frames.base_end.rotation;
  const Rows3<kColumns> spin = end_axes.transpose() * rows.spin;
  const Row<kColumns> excess = slide.by_seen * rows.seen + slide.by_spin * spin,
                      place = slide.along_by_seen * rows.seen + slide.along_by_spin * spin;
  rows.along = (end_axes * slide.axis) * place;
  rows.seen += slide.axis * place;
  rows.way += rows.along;
  const Vector6 by_begin = local.by_begin * slide.begin_axis;
  rows.force = frames.axes * (local.by_excess.template head<3>() * excess + by_begin.template head<3>() * place);
  rows.couple = frames.axes * (local.by_excess.template tail<3>() * excess + by_begin.template tail<3>() * place);
}

template <int kColumns>
void ContactElement::add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed,
                                 const Moving& moving, const PointAction& local, ForceAction& action) const {
  const int count = moving_nodes(), base = 6 * count;
  const bool is_body = count == 1, has_base = surface_.node >= 0;
  const Matrix3& end_axes = frames.base_end.rotation;
  Rows<kColumns> rows = rows_of<kColumns>(station, frames, placed);
  rows.force = rows.couple = Rows3<kColumns>::Zero(3, base + 6 * has_base);
  if (moving.tilt || moving.slide) {  // of a body
    rows.spin = rows.along = rows.force;
    if (is_body) rows.spin.template middleCols<3>(3).setIdentity();
    if (has_base) rows.spin.template middleCols<3>(base + 3).diagonal().setConstant(-1);
  }
  if (moving.slide) add_slide(frames, *moving.slide, local, rows);
  const Matrix6& slope = local.slope;
  rows.force += frames.axes * (slope.topLeftCorner<3, 3>() * rows.seen + slope.topRightCorner<3, 3>() * rows.turned);
  rows.couple +=
      frames.axes * (slope.bottomLeftCorner<3, 3>() * rows.seen + slope.bottomRightCorner<3, 3>() * rows.turned);
  if (moving.tilt) add_tilt(frames, *moving.tilt, local, rows);
  if (has_base) {
    rows.force.template middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.head<3>()));
    rows.couple.template middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.tail<3>()));
  }
  const Matrix3 pressed = frames.weight * hat(Vector3(frames.axes * local.wrench.head<3>()));
  Rows3<kColumns> moment = hat(placed.arm) * rows.force + rows.couple;
  if (moving.slide) moment -= pressed * rows.along;
  if (is_body) moment.template middleCols<3>(3) += pressed * hat(placed.end_arm);
  for (int i = 0; i < count; ++i) {
    action.tangent.middleRows<3>(6 * i) -= station.weights[i] * rows.force;
    action.tangent.middleRows<3>(6 * i + 3) -= station.weights[i] * moment;
  }
  if (!has_base) return;
  action.tangent.middleRows<3>(base) += rows.force;
  action.tangent.middleRows<3>(base + 3) += hat(placed.base_arm) * rows.force - pressed * rows.way + rows.couple;
}

// For one node against the world, two nodes, or a beam.
template void ContactElement::add_tangent<6>(const ContactStation&, const Frames&, const Placed&, const Moving&,
                                             const PointAction&, ForceAction&) const;
template void ContactElement::add_tangent<12>(const ContactStation&, const Frames&, const Placed&, const Moving&,
                                              const PointAction&, ForceAction&) const;
template void ContactElement::add_tangent<Eigen::Dynamic>(const ContactStation&, const Frames&, const Placed&,
                                                          const Moving&, const PointAction&, ForceAction&) const;

}  // namespace flexarm
