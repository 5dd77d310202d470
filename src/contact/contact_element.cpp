#include "contact/contact_element.h"

#include <algorithm>
#include <cassert>

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

std::vector<int> reach_of(const ContactStations& side, const ContactSurface& surface) {
  std::vector<int> nodes;
  if (side.nodes[0] >= 0) nodes = side.nodes;
  if (surface.node >= 0) nodes.push_back(surface.node);
  return nodes;
}

}  // namespace

ContactElement::ContactElement(std::vector<std::string> links, ContactStations side, ContactSurface surface,
                               const ContactLaw& law, bool is_reversed, const std::string& name)
    : ForceElement(name, reach_of(side, surface)),
      links_(std::move(links)),
      side_(std::move(side)),
      surface_(std::move(surface)),
      law_(law),
      is_reversed_(is_reversed) {
  assert(!side_.nodes.empty() && side_.nodes.size() <= ContactStation::kMostNodes);
  for (const ContactStation& station : side_.stations) {
    size_ = std::max(size_, station.arm.norm() + station.reach());
    middle_arm_ += station.arm / static_cast<double>(side_.stations.size());
    double sum = 0;
    for (const double weight : station.weights) sum += std::abs(weight);
    spread_ = std::max(spread_, sum);
  }
  for (const ContactStation& station : side_.stations)
    own_radius_ = std::max(own_radius_, (station.arm - middle_arm_).norm() + station.reach());
}

int ContactElement::memory_size() const {
  return PointMemory::kSize * static_cast<int>(side_.stations.size() * surface_.shapes.size());
}

ContactLaw ContactElement::law_of(const ContactStation& station) const {
  ContactLaw law = law_;
  law.stiffness *= station.share;
  law.grip *= station.share;
  law.turn_grip *= station.share;
  return law;
}

// ---------------------------------------------------------------- forces

/// Data of both sides over a step: means over the step, or values at its end, as the scheme requires. "Base" is the
/// node of the shapes. Rotation increments (turns) are tangent-scaled.
struct ContactElement::Frames {
  double weight;  // weight of the end in means
  NodePose base_begin, base_end;
  Matrix3 axes;  // axes of the shapes
  std::array<Vector3, ContactStation::kMostNodes> turns;
  Vector3 base_turn = Vector3::Zero();
};

ContactElement::Frames ContactElement::frames(const ForceStep& step) const {
  Frames out;
  out.weight = step.at_end ? 1 : 0.5;
  out.base_begin = poses_in(step.begin)(surface_.node);
  out.base_end = poses_in(step.end)(surface_.node);
  out.axes = out.weight * out.base_end.rotation + (1 - out.weight) * out.base_begin.rotation;
  const auto turn_of = [&](int node) {
    return node < 0 ? Vector3(Vector3::Zero())
                    : cayley::increment(step.begin[node].orientation, step.end[node].orientation);
  };
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) out.turns[i] = turn_of(side_.nodes[i]);
  out.base_turn = turn_of(surface_.node);
  return out;
}

/// A station over a step, in world axes.
struct ContactElement::Placed {
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // from its only node; zero for a beam
  Vector3 base_arm, end_base_arm;                            // from the shapes' node
  Vector3 turn;                                              // rotation increment minus that of the shapes
};

ContactElement::Placed ContactElement::placed(const ContactStation& station, const Frames& frames,
                                              const ForceStep& step) const {
  Placed out;
  const auto begin_of = poses_in(step.begin), end_of = poses_in(step.end);
  const double weight = frames.weight;
  const Vector3 begin = middle_of(side_, station, begin_of) - frames.base_begin.position;
  out.end_base_arm = middle_of(side_, station, end_of) - frames.base_end.position;
  out.base_arm = weight * out.end_base_arm + (1 - weight) * begin;
  out.turn = -frames.base_turn;
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) out.turn += station.weights[i] * frames.turns[i];
  if (side_.nodes.size() > 1) return out;
  out.end_arm = end_of(side_.nodes[0]).rotation * station.arm;
  out.arm = weight * out.end_arm + (1 - weight) * (begin_of(side_.nodes[0]).rotation * station.arm);
  return out;
}

/// A rim over a step. Its lowest point moves if it tilts. (docs/notes/contact.md 1.2)
struct ContactElement::Tilt {
  bool tilts = false;          // false: the station is no rim
  Vector3 axis, end_axis;      // of the rim, world axes, over the step and at the end
  Vector3 normal, end_normal;  // of the face, likewise
  RimLever lever;              // of the push, about `axis` x `normal`
  Matrix3 by_spin;             // of the offset at the end, all in the frame of the shapes

  /// Derivative of the end's cosine between axis and normal with respect to a spin of the rim, world axes.
  Eigen::RowVector3d cosine_by_spin() const { return end_axis.cross(end_normal).transpose(); }
};

ContactElement::Tilt ContactElement::tilt(const ContactStation& station, const ContactShape& shape,
                                          const PointMotion& motion, const Frames& frames,
                                          const ForceStep& step) const {
  Tilt out;
  if (station.rim == 0) return out;
  out.tilts = true;
  const Vector3 normal = face_normal(shape, motion.face);
  const Vector3 begin_axis = poses_in(step.begin)(side_.nodes[0]).rotation * station.axis;
  out.end_axis = poses_in(step.end)(side_.nodes[0]).rotation * station.axis;
  out.end_normal = frames.base_end.rotation * normal;
  out.axis = frames.weight * out.end_axis + (1 - frames.weight) * begin_axis;
  out.normal = frames.axes * normal;
  const double end = out.end_axis.dot(out.end_normal);
  out.lever = rim_lever(station.rim, step.at_end ? end : begin_axis.dot(frames.base_begin.rotation * normal), end);
  if (step.at_end) out.lever.slope *= 2;  // the lever is symmetric in both cosines
  out.by_spin =
      lowest_point_by_spin({motion.end, frames.base_end.rotation.transpose() * out.end_axis, station.rim}, normal);
  return out;
}

/// A segment over a step. It touches at a point that is fixed to it over the step, near to the nearest ones of both
/// ends. By how much these are nearer is the excess. (docs/notes/contact.md 1.2)
struct ContactElement::Slide {
  bool slides = false;     // false: the station is no segment
  bool is_away = false;    // no contact is possible in this step
  ContactStation station;  // that point
  double begin_excess = 0, end_excess = 0;
  Vector3 axis, begin_axis;  // of the segment at the end and at the beginning, in the shapes' frame
  // Derivatives of the excess at the end, and of the place along the segment, with respect to the point's position and
  // the segment's spin, in the frame of the shapes.
  Eigen::RowVector3d by_seen = Eigen::RowVector3d::Zero(), by_spin = by_seen;
  Eigen::RowVector3d along_by_seen = by_seen, along_by_spin = by_seen;
};

ContactElement::Slide ContactElement::slide(const ContactStation& station, const ContactShape& shape,
                                            const ForceStep& step) const {
  Slide out;
  if (station.half == 0) return out;
  out.slides = true;
  out.station = station;
  out.station.half = 0;
  const Segment begin = segment_of(side_, station, surface_, poses_in(step.begin)),
                end = segment_of(side_, station, surface_, poses_in(step.end));
  const NearestOnSegment first = nearest_on(begin, station.radius, shape);
  const double way = (end.middle - begin.middle).norm() + station.half * (end.axis - begin.axis).norm();
  out.is_away = first.distance - station.radius > way;
  if (out.is_away) return out;
  const NearestOnSegment last = nearest_on(end, station.radius, shape);
  const bool is_instant = step.at_end || step.duration == 0;
  const double along = is_instant ? last.along : midway(station, shape, step);
  out.station.arm += along * station.axis;
  const SignedDistance felt = shape.distance(end.at(along)), nearest = shape.distance(end.at(last.along));
  out.begin_excess = shape.distance(begin.at(along)).value - first.distance;
  out.end_excess = felt.value - last.distance;
  out.axis = end.axis, out.begin_axis = begin.axis;
  const Eigen::RowVector3d turned = (end.axis.cross(nearest.gradient)).transpose();  // of nearest.gradient . axis
  const double curvature = kBarrel * station.radius / (station.half * station.half);
  if (!is_instant) {
    out.by_seen = (felt.gradient - nearest.gradient).transpose();
    out.by_spin = (along - last.along) * turned;
  } else if (!last.is_end) {
    const Eigen::RowVector3d bent = end.axis.transpose() * nearest.hessian;
    const double rise = bent.dot(end.axis) + curvature;
    out.along_by_seen = -bent / rise;
    out.along_by_spin = -turned / rise;
    // The excess is minus the rise of the surface there.
    out.by_seen = -curvature * along * out.along_by_seen;
    out.by_spin = -curvature * along * out.along_by_spin;
  }
  return out;
}

/// The place along a segment that is nearest in the middle of a step, by the velocities at its beginning [m].
double ContactElement::midway(const ContactStation& station, const ContactShape& shape, const ForceStep& step) const {
  const auto begin_of = poses_in(step.begin);
  Segment segment = segment_of(side_, station, surface_, begin_of);
  const Vector3 end = velocity(station, begin_of, step.velocities, segment.axis),
                middle = velocity(station, begin_of, step.velocities);
  segment.middle += 0.5 * step.duration * middle;
  segment.axis = (segment.axis + 0.5 * step.duration * (end - middle)).normalized();
  return nearest_on(segment, station.radius, shape).along;
}

PointMotion ContactElement::motion_of(const ContactStation& station, const ContactShape& shape, int remembered,
                                      const ForceStep& step) const {
  const auto begin_of = poses_in(step.begin), end_of = poses_in(step.end);
  PointMotion out;
  out.face = face_of(side_, station, surface_, shape, remembered, begin_of);
  const StationPlace begin = place_of(side_, station, surface_, shape, out.face, begin_of),
                     end = place_of(side_, station, surface_, shape, out.face, end_of);
  out.begin = begin.middle, out.begin_offset = begin.offset;
  out.end = end.middle, out.end_offset = end.offset;
  out.begin_excess = -begin.rise, out.end_excess = -end.rise;
  if (step.duration != 0) out.begin_velocity = velocity(station, begin_of, step.velocities, begin.offset);
  out.outwards = outwards_of(side_, station, surface_, begin_of);
  return out;
}

void ContactElement::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  std::fill(step.new_memory, step.new_memory + memory_size(), 0.0);
  action.residual.setZero();
  action.tangent.setZero();
  if (action.residual.size() == 0) {  // no nodes are near
    action.dissipated = remembered_energy(step);
    return;
  }
  const Frames frames = this->frames(step);
  const double* memory = step.memory;
  double* new_memory = step.new_memory;
  for_each_pair([&](const ContactStation& given, const ContactShape& shape) {
    const bool is_new = std::all_of(memory, memory + PointMemory::kSize, [](double number) { return number == 0; });
    // The gap is a lower bound of the distance to the surface, so no contact is possible in this step.
    if (is_new) {
      const Vector3 begin = place(given, poses_in(step.begin)), end = place(given, poses_in(step.end));
      if (shape.gap(begin) - given.reach() > (end - begin).norm()) {
        memory += PointMemory::kSize;
        new_memory += PointMemory::kSize;
        return true;
      }
    }
    const Slide slide = this->slide(given, shape, step);
    if (is_new && slide.is_away) {
      memory += PointMemory::kSize;
      new_memory += PointMemory::kSize;
      return true;
    }
    const ContactStation& station = slide.slides ? slide.station : given;
    const Placed placed = this->placed(station, frames, step);
    const PointMemory old = memory_at(memory);
    PointMotion motion = motion_of(station, shape, old.face, step);
    if (slide.slides) {
      motion.begin_excess = slide.begin_excess;
      motion.end_excess = slide.end_excess;
      motion.lever = station.radius;
    }
    motion.turn = frames.axes.transpose() * placed.turn;
    motion.duration = step.duration;
    motion.at_end = step.at_end;
    const Tilt tilt = this->tilt(station, shape, motion, frames, step);
    const PointAction local =
        point_action(shape, law_of(station), station.radius, motion, old, action.tangent.size() > 0);
    action.dissipated += local.dissipated;
    action.work += local.work;
    put(local.memory, new_memory);
    memory += PointMemory::kSize;
    new_memory += PointMemory::kSize;
    if (local.acts) add(station, frames, placed, tilt, local, action);
    if (!local.acts || action.tangent.size() == 0) return true;
    if (action.tangent.rows() == 12)
      add_tangent<12>(station, frames, placed, tilt, slide, local, action);
    else if (action.tangent.rows() == 6)
      add_tangent<6>(station, frames, placed, tilt, slide, local, action);
    else
      add_tangent<Eigen::Dynamic>(station, frames, placed, tilt, slide, local, action);
    return true;
  });
}

/// Energy stored in contacts at the beginning of a step [J]. It is dissipated if these do not touch any more.
double ContactElement::remembered_energy(const ForceStep& step) const {
  double energy = 0;
  const double* memory = step.memory;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const PointMemory old = memory_at(memory);
    if (old.face != 0 || old.stretch != Vector3::Zero() || old.turned != Vector3::Zero())
      energy += stored_energy(station, shape, old, poses_in(step.begin));
    memory += PointMemory::kSize;
    return true;
  });
  return energy;
}

void ContactElement::add(const ContactStation& station, const Frames& frames, const Placed& placed, const Tilt& tilt,
                         const PointAction& local, ForceAction& action) const {
  const Vector3 force = frames.axes * local.wrench.head<3>();
  Vector3 couple = frames.axes * local.wrench.tail<3>();
  if (tilt.tilts) couple += local.push * tilt.lever.value * tilt.axis.cross(tilt.normal);
  Vector6 wrench;
  wrench << force, placed.arm.cross(force) + couple;
  const int count = moving_nodes();
  for (int i = 0; i < count; ++i) action.residual.segment<6>(6 * i) -= station.weights[i] * wrench;
  wrench << force, placed.base_arm.cross(force) + couple;
  if (surface_.node >= 0) action.residual.segment<6>(6 * count) += wrench;
}

/// Derivatives with respect to {displacement, spin} of all nodes.
template <int kColumns>
struct ContactElement::Rows {
  Rows3<kColumns> way, turn;      // of the station's position at the end and its rotation, relative to the base
  Rows3<kColumns> seen, turned;   // of both in the shapes' frame
  Rows3<kColumns> spin;           // of the spin of the only node relative to the base
  Row<kColumns> excess;           // see Slide
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
void ContactElement::add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed,
                                 const Tilt& tilt, const Slide& slide, const PointAction& local,
                                 ForceAction& action) const {
  const int count = moving_nodes(), base = 6 * count;
  const bool is_body = count == 1, has_base = surface_.node >= 0;
  const Matrix3& end_axes = frames.base_end.rotation;
  Rows<kColumns> rows;
  rows.way = Rows3<kColumns>::Zero(3, base + 6 * has_base);
  rows.turn = rows.way;
  for (int i = 0; i < count; ++i) {
    rows.way.template middleCols<3>(6 * i).diagonal().setConstant(station.weights[i]);
    rows.turn.template middleCols<3>(6 * i + 3) = station.weights[i] * cayley::inverse_tangent(frames.turns[i]);
  }
  if (is_body) rows.way.template middleCols<3>(3) = -hat(placed.end_arm);
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
  if (tilt.tilts || slide.slides) {
    rows.spin = Rows3<kColumns>::Zero(3, base + 6 * has_base);
    if (count > 0) rows.spin.template middleCols<3>(3).setIdentity();
    if (has_base) rows.spin.template middleCols<3>(base + 3) = -Matrix3::Identity();
  }
  const bool moves = slide.slides && !slide.along_by_seen.isZero(0);
  Rows3<kColumns> along;  // the point that touches moves along the segment by this, in an equilibrium
  Row<kColumns> place;
  if (slide.slides) {
    const Rows3<kColumns> spin = end_axes.transpose() * rows.spin;
    rows.excess = slide.by_seen * rows.seen + slide.by_spin * spin;
    if (moves) {
      place = slide.along_by_seen * rows.seen + slide.along_by_spin * spin;
      rows.seen += slide.axis * place;
      along = (end_axes * slide.axis) * place;
      rows.way += along;
    }
  }
  const Matrix6& slope = local.slope;
  rows.force = frames.axes * (slope.topLeftCorner<3, 3>() * rows.seen + slope.topRightCorner<3, 3>() * rows.turned);
  rows.couple =
      frames.axes * (slope.bottomLeftCorner<3, 3>() * rows.seen + slope.bottomRightCorner<3, 3>() * rows.turned);
  if (tilt.tilts) add_tilt(frames, tilt, local, rows);
  if (slide.slides) {
    rows.force += frames.axes * local.by_excess.template head<3>() * rows.excess;
    rows.couple += frames.axes * local.by_excess.template tail<3>() * rows.excess;
    if (moves) {  // also at the beginning, from which friction counts
      rows.force += frames.axes * (local.by_begin.template topRows<3>() * slide.begin_axis) * place;
      rows.couple += frames.axes * (local.by_begin.template bottomRows<3>() * slide.begin_axis) * place;
    }
  }
  if (has_base) {
    rows.force.template middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.head<3>()));
    rows.couple.template middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.tail<3>()));
  }
  const Matrix3 pressed = frames.weight * hat(Vector3(frames.axes * local.wrench.head<3>()));
  Rows3<kColumns> moment = hat(placed.arm) * rows.force + rows.couple;
  if (is_body) moment.template middleCols<3>(3) += pressed * hat(placed.end_arm);
  if (moves) moment -= pressed * along;
  for (int i = 0; i < count; ++i) {
    action.tangent.middleRows<3>(6 * i) -= station.weights[i] * rows.force;
    action.tangent.middleRows<3>(6 * i + 3) -= station.weights[i] * moment;
  }
  if (!has_base) return;
  action.tangent.middleRows<3>(base) += rows.force;
  action.tangent.middleRows<3>(base + 3) += hat(placed.base_arm) * rows.force - pressed * rows.way + rows.couple;
}

}  // namespace flexarm
