#include "contact/contact_step.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "math/cayley.h"

namespace flexarm {
namespace {

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

ContactElement::Placed ContactElement::placed(const ContactStation& station, const Frames& frames,
                                              const ForceStep& step, const Seen& seen) const {
  Placed out;
  const auto begin_of = poses_in(step.begin), end_of = poses_in(step.end);
  const double weight = frames.weight;
  const Vector3 begin = frames.base_begin.rotation * seen.begin.middle(station);
  out.end_base_arm = frames.base_end.rotation * seen.end.middle(station);
  out.base_arm = weight * out.end_base_arm + (1 - weight) * begin;
  out.turn = -frames.base_turn;
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) out.turn += station.weights[i] * frames.turns[i];
  if (side_.nodes.size() > 1) return out;
  out.end_arm = end_of(side_.nodes[0]).rotation * station.arm;
  out.arm = weight * out.end_arm + (1 - weight) * (begin_of(side_.nodes[0]).rotation * station.arm);
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
  const Seen seen = this->seen(step);
  const double* memory = step.memory;
  double* new_memory = step.new_memory;
  for_each_pair([&](const ContactStation& given, const ContactShape& shape) {
    const bool is_new = std::all_of(memory, memory + PointMemory::kSize, [](double number) { return number == 0; });

    const bool is_far = is_new && !may_touch(given, shape, seen);
    std::optional<Slide> slide;
    if (!is_far && given.half > 0) slide = this->slide(given, shape, step, seen);
    if (is_far || (is_new && slide && slide->is_away)) {
      memory += PointMemory::kSize;
      new_memory += PointMemory::kSize;
      return true;
    }
    const ContactStation& station = slide ? slide->station : given;
    const Placed placed = this->placed(station, frames, step, seen);
    const PointMemory old = memory_at(memory);
    PointMotion motion = motion_of(station, shape, old.face, seen);
    if (slide) {
      motion.begin_excess = slide->begin_excess;
      motion.end_excess = slide->end_excess;
      motion.lever = station.radius;
    }
    motion.turn = frames.axes.transpose() * placed.turn;
    motion.duration = step.duration;
    motion.at_end = step.at_end;
    std::optional<Tilt> tilt;
    if (station.rim > 0) tilt = this->tilt(station, shape, motion, frames, step);
    const Moving moving{tilt ? &*tilt : nullptr, slide ? &*slide : nullptr};
    const PointAction local =
        point_action(shape, law_of(station), station.radius, motion, old, action.tangent.size() > 0);
    action.dissipated += local.dissipated;
    action.work += local.work;
    put(local.memory, new_memory);
    memory += PointMemory::kSize;
    new_memory += PointMemory::kSize;
    if (local.acts) add(station, frames, placed, moving, local, action);
    if (!local.acts || action.tangent.size() == 0) return true;
    if (action.tangent.rows() == 12)
      add_tangent<12>(station, frames, placed, moving, local, action);
    else if (action.tangent.rows() == 6)
      add_tangent<6>(station, frames, placed, moving, local, action);
    else
      add_tangent<Eigen::Dynamic>(station, frames, placed, moving, local, action);
    return true;
  });
}

/// Energy stored in contacts at the beginning of a step [J]. It is dissipated if these do not touch any more.
double ContactElement::remembered_energy(const ForceStep& step) const {
  double energy = 0;
  const SeenStations seen = this->seen(poses_in(step.begin));
  const double* memory = step.memory;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const PointMemory old = memory_at(memory);
    if (old.face != 0 || old.stretch != Vector3::Zero() || old.turned != Vector3::Zero())
      energy += stored_energy(station, shape, old, seen);
    memory += PointMemory::kSize;
    return true;
  });
  return energy;
}

void ContactElement::add(const ContactStation& station, const Frames& frames, const Placed& placed,
                         const Moving& moving, const PointAction& local, ForceAction& action) const {
  const Vector3 force = frames.axes * local.wrench.head<3>();
  Vector3 couple = frames.axes * local.wrench.tail<3>();
  if (moving.tilt) couple += local.push * moving.tilt->lever.value * moving.tilt->axis.cross(moving.tilt->normal);
  Vector6 wrench;
  wrench << force, placed.arm.cross(force) + couple;
  const int count = moving_nodes();
  for (int i = 0; i < count; ++i) action.residual.segment<6>(6 * i) -= station.weights[i] * wrench;
  wrench << force, placed.base_arm.cross(force) + couple;
  if (surface_.node >= 0) action.residual.segment<6>(6 * count) += wrench;
}

}  // namespace flexarm
