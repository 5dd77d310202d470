#include "elements/tendon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "elements/tendon_inside.h"
#include "math/pi.h"

namespace flexarm {
namespace {

/// The nodes of a plan, each once.
std::vector<int> nodes_of(const TendonPlan& plan) {
  std::vector<int> nodes;
  std::unordered_set<int> known{-1};
  const auto add = [&](int node) {
    if (known.insert(node).second) nodes.push_back(node);
  };
  for (const TendonGuide& guide : plan.guides) add(guide.place.node);
  for (const TendonWinch& winch : plan.winches) add(winch.node);
  return nodes;
}

/// Lines over so few nodes have one dense matrix (docs/notes/lines.md 5).
constexpr std::size_t kMostDenseNodes = 4;

/// In pictures a turn on a pulley consists of so many straight parts.
constexpr int kMostArcs = 36;

/// Length of rim per angle at which the line comes, and minus that at which it goes, counted as length of the line.
double rim(const GuidePlace& guide) {
  return guide.sense * guide.radius;
}

}  // namespace

Tendon::Tendon(std::string name, TendonPlan plan, std::vector<int> functions, const std::vector<NodePose>& poses)
    : ForceElement(std::move(name), nodes_of(plan), std::move(functions)), plan_(std::move(plan)) {
  std::unordered_map<int, int> places{{-1, -1}};
  for (const int node : reach()) places.emplace(node, static_cast<int>(places.size()) - 1);
  for (const TendonGuide& guide : plan_.guides) guide_nodes_.push_back(places[guide.place.node]);
  for (const TendonWinch& winch : plan_.winches) winch_nodes_.push_back(places[winch.node]);
  const int last = static_cast<int>(plan_.guides.size()) - 1;
  for (int i = 1; i < last; ++i) {
    if (plan_.guides[i].divides()) part_ends_.push_back(i);
    may_lift_ = may_lift_ || (plan_.guides[i].place.is_circle() && !plan_.guides[i].divides());
  }
  parts_ = static_cast<int>(part_ends_.size());
  part_ends_.push_back(last);
  find_part_nodes();
  find_pieces();
  shares_.assign(parts_, 1.0);
  std::vector<double> numbers(memory_size(), 0.0);
  const NewMemory memory{numbers.data(), parts_};
  lay(Poses(poses), 0, memory);
  for (int part = 0; part < parts_; ++part) shares_[part] = lengths(Poses(poses), memory, part).length;
  length_at_start_ = std::accumulate(shares_.begin(), shares_.end(), 0.0);
  for (double& share : shares_) share /= length_at_start_;
  if (plan_.rest_length == 0) plan_.rest_length = length_at_start_;
}

void Tendon::find_part_nodes() {
  part_nodes_.resize(parts_);
  guide_places_.assign(plan_.guides.size(), {-1, -1});
  const auto place = [&](int part, int node) {
    std::vector<int>& nodes = part_nodes_[part];
    if (node < 0) return -1;
    const auto known = std::find(nodes.begin(), nodes.end(), node);
    const int at = static_cast<int>(known - nodes.begin());
    if (known == nodes.end()) nodes.push_back(node);
    return at;
  };
  for (int part = 0; part < parts_; ++part)
    for (int i = part_ends_[part]; i <= part_ends_[part + 1]; ++i) {
      const int at = place(part, guide_nodes_[i]);
      if (i > part_ends_[part]) guide_places_[i].before = at;
      if (i < part_ends_[part + 1]) guide_places_[i].behind = at;
    }
  for (const int node : winch_nodes_) winch_places_.push_back(place(0, node));
}

/// A piece may lead from each guide to the next one, and to those behind pulleys that the line may leave.
void Tendon::find_pieces() {
  const int last = static_cast<int>(plan_.guides.size()) - 1;
  if (reach().size() <= kMostDenseNodes) return;
  const auto may_leave = [&](int i) {
    return plan_.guides[i].place.is_circle() && !plan_.guides[i].divides() && i < last;
  };
  std::vector<std::array<int, 2>>& pairs = pieces_.pairs;
  for (int i = 0; i < last; ++i) {
    first_piece_.push_back(static_cast<int>(pairs.size()));
    for (int j = i + 1; j <= last; ++j) {
      pairs.push_back({guide_nodes_[i], guide_nodes_[j]});
      if (!may_leave(j)) break;
    }
  }
  if (pairs.size() > 4 * plan_.guides.size()) return pairs.clear();  // many pulleys in succession
  pieces_.groups = part_nodes_;
  pieces_.rank = group_rank();
}

/// The auxiliary variables of a part are the change of its length, that of its rest length, and what slips behind it;
/// the last two, or the last one, only where that can occur.
int Tendon::group_rank() const {
  if (plan_.has_tension) return 0;
  const std::vector<TendonGuide>& guides = plan_.guides;
  if (std::any_of(guides.begin(), guides.end(), [](const TendonGuide& guide) { return guide.friction > 0; })) return 3;
  const bool winds = std::any_of(guides.begin(), guides.end(),
                                 [](const TendonGuide& guide) { return guide.divides() && guide.place.is_circle(); });
  return winds || std::any_of(winch_nodes_.begin(), winch_nodes_.end(), [](int i) { return i >= 0; }) ? 2 : 1;
}

std::string Tendon::description() const {
  std::string text = plan_.has_tension
                         ? "given tension"
                         : fmt::format("EA {:.6g} N, {:.6g} N s/m", plan_.law.stiffness, plan_.law.damping);
  return parts_ == 1 ? text : fmt::format("{}, {} parts", text, parts_);
}

bool Tendon::suits_backward_steps() const {
  return std::all_of(plan_.guides.begin(), plan_.guides.end(), [](const auto& guide) { return guide.friction == 0; });
}

Tendon::Neighbours Tendon::neighbours(const Memory& memory, int guide) const {
  Neighbours out{guide - 1, guide + 1};
  while (memory.touched(out.before) == 0) --out.before;
  while (memory.touched(out.behind) == 0) ++out.behind;
  return out;
}

Tendon::Span Tendon::span(int first, int second, int part) const {
  const TendonGuide &from = plan_.guides[first], &to = plan_.guides[second];
  Span out{{from.place, to.place},
           first,
           second,
           part,
           guide_nodes_[first],
           guide_nodes_[second],
           guide_places_[first].behind,
           guide_places_[second].before,
           {1, 0, 0},
           {},
           false};
  (from.divides() ? out.rest.begin : out.length.begin) = from.divides() ? -rim(from.place) : rim(from.place);
  (to.divides() ? out.rest.end : out.length.end) = to.divides() ? rim(to.place) : -rim(to.place);
  out.winds = (from.divides() && from.place.is_circle()) || (to.divides() && to.place.is_circle());
  return out;
}

double Tendon::paid_out(const Poses& poses) const {
  double out = 0;
  for (const TendonWinch& winch : plan_.winches)
    out += (winch.node < 0 ? winch.still : winch.direction.dot(poses[winch.node].position)) - winch.zero;
  return out;
}

double Tendon::straight_rest(const Poses& poses, const Memory& memory, int part) const {
  return shares_[part] * memory.function() - memory.rims_at_start(part) + (part == 0 ? paid_out(poses) : 0);
}

TendonLengths Tendon::lengths(const Poses& poses, const Memory& memory, int part) const {
  TendonLengths out{0, straight_rest(poses, memory, part)};
  for_each_span(memory, part, [&](const Span& span) {
    const PieceState state = span.piece.follow(poses.of(span.piece), memory.angles(span.first, span.second));
    out.length += state.value(span.length);
    out.rest += state.value(span.rest);
  });
  return out;
}

double Tendon::energy(const Poses& poses, const Memory& memory) const {
  double out = 0;
  for (int part = 0; part < parts_ && !plan_.has_tension; ++part) out += plan_.law.energy(lengths(poses, memory, part));
  return out;
}

double Tendon::energy(const State& state, const double* memory) const {
  return energy(Poses(state), Memory{memory, parts_});
}

void Tendon::find_angles(const Poses& poses, const NewMemory& memory) const {
  for_each_span(memory, [&](const Span& span) {
    const PieceState state = span.piece.find(poses.of(span.piece), memory.angles(span.first, span.second));
    memory.goes(span.first) = state.begin;
    memory.comes(span.second) = state.end;
  });
}

void Tendon::start(const State& state, const double* functions, double* numbers) const {
  lay(Poses(state), this->functions().empty() ? plan_.rest_length : functions[0], {numbers, parts_});
}

/// What drums have wound up and what has slipped stays, and so do the rest lengths of all parts.
void Tendon::carry(const ForceElement& before, const double* old_numbers, const State& state, double* numbers) const {
  const auto* other = dynamic_cast<const Tendon*>(&before);
  if (!other || other->parts_ != parts_ || other->plan_.guides.size() != plan_.guides.size()) return;
  const Memory old{old_numbers, parts_};
  const NewMemory memory{numbers, parts_};
  const double function = functions().empty() ? plan_.rest_length : memory.function();
  std::copy_n(old_numbers, memory_size(), numbers);
  memory.function() = function;
  for (int part = 0; part < parts_; ++part)
    memory.rims_at_start(part) += shares_[part] * function - other->shares_[part] * old.function();
  find_angles(Poses(state), memory);
  find_touched(Poses(state), memory);
}

/// Sets the memory to that of a line that has not moved yet.
void Tendon::lay(const Poses& poses, double function, const NewMemory& memory) const {
  memory.function() = function;
  const int count = static_cast<int>(plan_.guides.size());
  for (int i = 0; i < count; ++i) memory.touched(i) = 1;
  find_angles(poses, memory);
  for (int i = 0; i < count; ++i) {
    const GuidePlace& place = plan_.guides[i].place;
    const double wrap = plan_.guides[i].wrap;
    if (place.is_circle()) memory.goes(i) = nearest_turn(memory.goes(i), memory.comes(i) + place.sense * wrap);
  }
  find_touched(poses, memory);
  for (int part = 0; part < parts_; ++part) memory.rims_at_start(part) = 0;
  for_each_span(memory, [&](const Span& span) {
    memory.rims_at_start(span.part) += memory.angles(span.first, span.second).value(span.rest);
  });
}

bool Tendon::find_touched(const Poses& poses, const NewMemory& memory) const {
  bool has_changed = false;
  const int last = static_cast<int>(plan_.guides.size()) - 1;
  for (int i = 1; i < last; ++i) {
    const GuidePlace& place = plan_.guides[i].place;
    if (!place.is_circle() || plan_.guides[i].divides()) continue;
    const auto [before, behind] = neighbours(memory, i);
    if (memory.touched(i) != 0) {
      if (place.sense * (memory.goes(i) - memory.comes(i)) >= 0) continue;
      memory.touched(i) = 0;
    } else {
      // Angles are followed over turns, so that a line that swings round beside the pulley does not come to its rim.
      const Span comes = span(before, i, 0), goes = span(i, behind, 0);
      const double from = comes.piece.find(poses.of(comes.piece), memory.angles(before, i)).end;
      const double to = goes.piece.find(poses.of(goes.piece), memory.angles(i, behind)).begin;
      if (!std::isfinite(from + to)) continue;  // a neighbour is within the circle
      memory.comes(i) = from;
      memory.goes(i) = to;
      if (!(place.sense * (to - from) > 0)) continue;
      memory.touched(i) = 1;
    }
    has_changed = true;
    find_angles(poses, memory);  // those of the neighbours have changed
  }
  return has_changed;
}

// ---------------------------------------------------------------- small motions and output

void Tendon::find_gradients(const Poses& poses, const Memory& memory, int part, PartForces& out) const {
  out.reset(part_nodes_[part].size());
  const auto add = [](Eigen::VectorXd& sum, const Span& span, const Vector12& gradient) {
    if (span.first_place >= 0) sum.segment<6>(6 * span.first_place) += gradient.head<6>();
    if (span.second_place >= 0) sum.segment<6>(6 * span.second_place) += gradient.tail<6>();
  };
  for_each_span(memory, part, [&](const Span& span) {
    if (span.first_node == span.second_node) return;
    const PiecePoses at = poses.of(span.piece);
    const PieceState here = span.piece.follow(at, memory.angles(span.first, span.second));
    add(out.length, span, span.piece.gradient(at, here, span.length));
    if (span.winds) add(out.rest, span, span.piece.gradient(at, here, span.rest));
  });
  for (std::size_t i = 0; i < plan_.winches.size(); ++i)
    if (part == 0 && winch_places_[i] >= 0) out.rest.segment<3>(6 * winch_places_[i]) += plan_.winches[i].direction;
}

double Tendon::stretch_rate(const Poses& poses, const Memory& memory, int part,
                            const std::vector<Vector6>& velocities) const {
  double rate = 0;
  for_each_span(memory, part, [&](const Span& span) {
    const int nodes[2] = {span.piece.first().node, span.piece.second().node};
    if (nodes[0] == nodes[1]) return;
    const PiecePoses at = poses.of(span.piece);
    const PieceState here = span.piece.follow(at, memory.angles(span.first, span.second));
    const Vector12 gradient = span.piece.gradient(at, here, span.length - span.rest);
    for (int i = 0; i < 2; ++i)
      if (nodes[i] >= 0) rate += gradient.segment<6>(6 * i).dot(velocities[nodes[i]]);
  });
  for (const TendonWinch& winch : plan_.winches)
    if (part == 0 && winch.node >= 0) rate -= winch.direction.dot(velocities[winch.node].head<3>());
  return rate;
}

ForceMeasures Tendon::measures(const State& state, const double* memory, const int*) const {
  const Memory view{memory, parts_};
  const Poses poses(state);
  ForceMeasures out{Eigen::MatrixXd::Zero(parts_, 6 * reach().size()), Eigen::MatrixXd::Zero(parts_, parts_)};
  for (int part = 0; part < parts_; ++part) {
    PartForces gradient;
    find_gradients(poses, view, part, gradient);
    const TendonLengths line = lengths(poses, view, part);
    const bool stretches = !plan_.has_tension && plan_.law.is_taut(line);
    // The energy is of first degree in both lengths, so its second derivative has rank one.
    const double by_rest = stretches ? line.length / line.rest : 1.0;
    for (std::size_t i = 0; i < part_nodes_[part].size(); ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      out.rows.row(part).segment<6>(6 * part_nodes_[part][i]) =
          gradient.length.segment<6>(at) - by_rest * gradient.rest.segment<6>(at);
    }
    if (stretches) out.stiffness(part, part) = plan_.law.stiffness / line.rest;
  }
  return out;
}

DamperTensions Tendon::dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const {
  const Memory view{memory, parts_};
  DamperTensions out{Eigen::VectorXd::Zero(parts_), Eigen::MatrixXd::Zero(parts_, parts_)};
  for (int part = 0; part < parts_ && !plan_.has_tension; ++part) {
    const TendonLengths line = lengths(Poses(state), view, part);
    if (!plan_.law.is_taut(line) || plan_.law.tension(line) + plan_.law.damping * rates[part] < 0) continue;
    out.tension[part] = plan_.law.damping * rates[part];
    out.slope(part, part) = plan_.law.damping;
  }
  return out;
}

std::vector<ForceOutput> Tendon::outputs() const {
  if (parts_ == 1) return {{"length", "m"}, {"tension", "N"}};
  return {{"length", "m"}, {"tension", "N"}, {"last_tension", "N"}};
}

void Tendon::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  const Memory memory{motion.memory, parts_};
  const Poses poses(motion.state);
  double length = 0, first = 0, last = 0;
  for (int part = 0; part < parts_; ++part) {
    const TendonLengths line = lengths(poses, memory, part);
    length += line.length;
    last = std::max(memory.function(), 0.0);
    if (!plan_.has_tension) {
      const double by_function = functions().empty() ? 0 : shares_[part] * motion.function_rates[0];
      const double rate = stretch_rate(poses, memory, part, motion.velocities) - by_function - memory.slip_rate(part);
      last = plan_.law.is_taut(line) ? std::max(plan_.law.tension(line) + plan_.law.damping * rate, 0.0) : 0;
    }
    if (part == 0) first = last;
  }
  values.push_back(length);
  values.push_back(first);
  if (parts_ > 1) values.push_back(last);
}

std::size_t Tendon::most_line_points() const {
  std::size_t points = 0;
  for (const TendonGuide& guide : plan_.guides) points += guide.place.is_circle() ? 2 * kMostArcs + 1 : 1;
  return points;
}

void Tendon::put_line(const ForceMotion& motion, std::vector<Vector3>& points) const {
  const Memory memory{motion.memory, parts_};
  const Poses poses(motion.state);
  const int last = static_cast<int>(plan_.guides.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    if (memory.touched(i) == 0) continue;
    const GuidePlace& place = plan_.guides[i].place;
    // What is wound up at the ends of the line is not drawn.
    const double from = i == 0 ? memory.goes(i) : memory.comes(i), to = i == last ? memory.comes(i) : memory.goes(i);
    // Several turns look like one and a part.
    const double way =
        std::abs(to - from) < 2 * kPi ? to - from : std::fmod(to - from, 2 * kPi) + std::copysign(2 * kPi, to - from);
    const int steps = place.is_circle() ? static_cast<int>(std::ceil(std::abs(way) / (2 * kPi) * kMostArcs)) : 0;
    for (int k = 0; k <= steps; ++k) {
      const double angle = steps == 0 ? from : from + way * k / steps;
      points.push_back(poses.point(place, angle));
    }
  }
}

}  // namespace flexarm
