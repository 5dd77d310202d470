#include "pictures/recording.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pictures/picture_json.h"
#include "pictures/run_extent.h"
#include "pictures/tracks.h"

namespace flexarm::pictures {
namespace {

/// Of a longer run every second instant is dropped. An hour of a display would be a page that browsers open slowly.
constexpr std::size_t kMostInstants = 20000;

void append(const Vector3& vector, std::vector<double>& values) {
  values.insert(values.end(), vector.data(), vector.data() + vector.size());
}

void append(const Pose& pose, std::vector<double>& values) {
  append(pose.position, values);
  for (int i = 0; i < 4; ++i) values.push_back(pose.orientation.coeffs()[i]);  // x y z w
}

ResultColumns columns_of(const Simulation& simulation, const RecordingOptions& options) {
  return ResultColumns(simulation, ResultColumns::Solver::With, options.columns);
}

}  // namespace

bool measures_reaction(const scene::Sensor& sensor) {
  return scene::traits_of(sensor.kind).place == scene::SensedPlace::Joint;
}

void append_line(const Simulation& simulation, const PictureLine& line, std::vector<Vector3>& scratch,
                 std::vector<double>& values) {
  simulation.line_points(line.element, scratch);
  scratch.resize(line.points, scratch.empty() ? Vector3::Zero() : scratch.back());
  for (const Vector3& point : scratch) append(point, values);
}

void Instant::append(const Simulation& simulation, const StepCounts& counts, std::vector<double>& values) {
  for (std::size_t i = 0; i < picture_.links.size(); ++i) pictures::append(simulation.link_pose(i), values);
  for (const PictureBeam& beam : picture_.beams) {
    points_.clear();
    simulation.beam_points(beam.link, beam.between, points_);
    for (const BeamPoint& point : points_) {
      pictures::append(point.pose, values);
      for (const Vector6& numbers : {point.strain, point.resultant})
        values.insert(values.end(), numbers.data(), numbers.data() + numbers.size());
    }
  }
  for (std::size_t i = 0; i < picture_.probes.size(); ++i) pictures::append(simulation.probe_pose(i).position, values);
  for (const PictureLine& line : picture_.lines) append_line(simulation, line, line_points_, values);
  const std::vector<double>& row = columns_.row(simulation, counts);
  values.insert(values.end(), row.begin(), row.end());
}

void find_reactions(const Simulation& simulation, std::vector<ActingWrench>& reactions) {
  reactions.clear();
  const std::vector<scene::Sensor>& sensors = simulation.scene().sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (measures_reaction(sensors[i])) reactions.push_back(simulation.sensed_wrench(i));
}

void find_pushes(const Simulation& simulation, std::vector<ActingWrench>& pushes) {
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  pushes.clear();
  for (const ActingContact& contact : contacts) pushes.push_back({contact.position, {contact.force, Vector3::Zero()}});
}

void find_arrows(const Simulation& simulation, Arrows& arrows) {
  auto& [efforts, loads, reactions, pushes] = arrows;
  simulation.effort_wrenches(efforts);
  simulation.outside_wrenches(loads);
  find_reactions(simulation, reactions);
  find_pushes(simulation, pushes);
}

std::vector<std::size_t> quaternions_of(const Picture& picture) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < picture.links.size(); ++i) places.push_back(7 * i + 3);
  std::size_t first = 7 * picture.links.size();
  for (const PictureBeam& beam : picture.beams)
    for (std::size_t k = 0; k < beam.sections.size(); ++k, first += 19) places.push_back(first + 3);
  return places;
}

void keep_signs(const std::vector<std::size_t>& quaternions, const std::vector<double>& last,
                std::vector<double>& values) {
  for (const std::size_t place : quaternions) {
    double product = 0;
    for (std::size_t k = place; k < place + 4; ++k) product += last[k] * values[k];
    if (product < 0)
      for (std::size_t k = place; k < place + 4; ++k) values[k] = -values[k];
  }
}

// ---------------------------------------------------------------- recording

Recording::Recording(const Simulation& simulation, const RecordingOptions& options)
    : picture_(picture_of(simulation, columns_of(simulation, options).columns())),
      instant_(std::in_place, picture_, columns_of(simulation, options)),
      has_arrows_(options.has_arrows),
      due_(options.rate) {
  picture_.title = options.title;
}

Recording::Recording(Picture picture, double rate) : picture_(std::move(picture)), has_arrows_(true), due_(rate) {}

double Recording::last_time() const {
  return times_.empty() ? std::numeric_limits<double>::quiet_NaN() : times_.back();
}

void Recording::keep(const Simulation& simulation, const StepCounts& counts) {
  std::vector<double> values;
  if (!values_.empty()) values.reserve(values_.front().size());
  instant_->append(simulation, counts, values);
  Arrows arrows;
  if (has_arrows_) find_arrows(simulation, arrows);
  keep(simulation.time(), std::move(values), std::move(arrows));
}

void Recording::keep(double time, std::vector<double> values, Arrows arrows) {
  const bool is_a_run = clips_.empty() && still_ < 0;  // else indices of instants are kept
  if (is_a_run && times_.size() == kMostInstants) thin_out();
  times_.push_back(time);
  values_.push_back(std::move(values));
  arrows_.push_back(std::move(arrows));
  due_.note(time);
}

StepResult Recording::run(Simulation& simulation, double until, const std::function<bool(Simulation&)>& before_step) {
  StepResult result;
  result.converged = true;
  StepCounts counts;
  if (times_.empty()) keep(simulation, counts);
  while (result.converged && simulation.time() < until - 0.5 * simulation.step_size() && before_step(simulation)) {
    result = simulation.step();
    counts.add(result);
    if (!result.converged || !is_due(simulation)) continue;
    keep(simulation, counts);
    counts = {};
  }
  if (last_time() != simulation.time()) keep(simulation, counts);
  return result;
}

void Recording::thin_out() {
  const std::size_t half = times_.size() / 2;
  for (std::size_t i = 1; i < half; ++i) {
    times_[i] = times_[2 * i];
    values_[i] = std::move(values_[2 * i]);
    arrows_[i] = std::move(arrows_[2 * i]);
  }
  times_.resize(half);
  values_.resize(half);
  arrows_.resize(half);
  due_.thin_out();
}

void Recording::end_clip(const std::string& name, std::size_t first) {
  clips_.push_back({name, first, times_.size() - first});
}

std::array<std::size_t, kArrowKinds> Recording::most_arrows() const {
  std::array<std::size_t, kArrowKinds> most = {};
  for (const Arrows& arrows : arrows_)
    for (std::size_t kind = 0; kind < kArrowKinds; ++kind) most[kind] = std::max(most[kind], arrows[kind].size());
  return most;
}

namespace {

/// The number `part` (position, force, moment) of an arrow that may be missing.
double arrow_number(const Arrows& arrows, std::size_t kind, std::size_t index, std::size_t part) {
  if (index >= arrows[kind].size()) return 0;
  const ActingWrench& arrow = arrows[kind][index];
  const Vector3* const parts[] = {&arrow.position, &arrow.wrench.force, &arrow.wrench.moment};
  return (*parts[part / 3])[static_cast<Eigen::Index>(part % 3)];
}

}  // namespace

EncodedRun Recording::encode() const {
  const auto most = most_arrows();
  std::vector<std::vector<double>> values = values_;
  const std::vector<std::size_t> quaternions = quaternions_of(picture_);
  for (std::size_t i = 1; i < values.size(); ++i) keep_signs(quaternions, values[i - 1], values[i]);
  std::string bytes;
  append_numbers(times_, bytes);
  std::vector<double> track(times_.size());
  const auto append_values = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = 0; i < track.size(); ++i) track[i] = values[i][k];
      append_track(track, bytes);
    }
  };
  const std::size_t width = values.empty() ? 0 : values.front().size();
  const std::size_t columns = width - std::min(width, picture_.columns.size());
  append_values(0, columns);
  for (std::size_t kind = 0; kind < kArrowKinds; ++kind)
    for (std::size_t index = 0; index < most[kind]; ++index)
      for (std::size_t part = 0; part < 9; ++part) {
        for (std::size_t i = 0; i < track.size(); ++i) track[i] = arrow_number(arrows_[i], kind, index, part);
        append_track(track, bytes);
      }
  append_values(columns, width);
  for (const PictureMesh& mesh : picture_.meshes) append_mesh(mesh.surface, bytes);
  const RunShape shape{times_.size(), most, clips_, still_, run_extent(picture_, values)};
  return {picture_as_json(picture_, shape), deflated(bytes), picture_.notes};
}

}  // namespace flexarm::pictures
