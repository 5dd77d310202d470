#include "flexarm/simulation/result_columns.h"

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <stdexcept>

#include <fnmatch.h>

#include <fmt/format.h>

#include "flexarm/math/near_names.h"
#include "flexarm/scene/scene_description.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

using Row = std::vector<double>;

void append(Row& row, const Vector3& vector) {
  row.insert(row.end(), vector.data(), vector.data() + vector.size());
}

void append(Row& row, const Pose& pose) {
  append(row, pose.position);
  for (int i = 0; i < 4; ++i) row.push_back(pose.orientation.coeffs()[i]);  // x y z w
}

// ---------------------------------------------------------------- values of groups

void time_values(const Simulation& simulation, const StepCounts&, std::size_t, Row& row) {
  row.push_back(simulation.time());
}
void position_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  row.push_back(simulation.position(i));
}
void velocity_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  row.push_back(simulation.velocity(i));
}
void effort_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  row.push_back(simulation.effort(i));
}
void frame_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  append(row, simulation.link_pose(i));
}
void probe_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  append(row, simulation.probe_pose(i));
}
void probe_velocity_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  append(row, simulation.probe(i).velocity);
}
void acceleration_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  append(row, simulation.probe_acceleration(i).linear);
}
void sensor_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  const std::size_t count = scene::sensor_channels(simulation.scene().sensors.at(i).kind).size();
  const auto& values = simulation.sample(i).values;
  row.insert(row.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}
void force_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  put_out_force(simulation, i, row);
}
void touch_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  put_out_touch(simulation, i, row);
}
/// The sections of a beam at its nodes, one after the other.
void section_values(const Simulation& simulation, const StepCounts&, std::size_t i, Row& row) {
  std::vector<BeamPoint> points;
  simulation.beam_points(i, 0, points);
  for (const BeamPoint& point : points) {
    append(row, point.pose);
    for (const Vector6& numbers : {point.strain, point.resultant})
      row.insert(row.end(), numbers.data(), numbers.data() + numbers.size());
  }
}
void energy_values(const Simulation& simulation, const StepCounts&, std::size_t, Row& row) {
  const Energies e = simulation.energies();
  row.insert(row.end(), {e.kinetic, e.strain, e.potential, e.total(), e.work, e.dissipated});
}
void momentum_values(const Simulation& simulation, const StepCounts&, std::size_t, Row& row) {
  append(row, simulation.momentum());
}
void angular_momentum_values(const Simulation& simulation, const StepCounts&, std::size_t, Row& row) {
  append(row, simulation.angular_momentum());
}
void solver_values(const Simulation& simulation, const StepCounts& counts, std::size_t, Row& row) {
  const double last = state_of(simulation).drives.durations[0];
  row.push_back(last > 0 ? last : simulation.step_size());
  for (const long count : {counts.iterations, counts.halvings, static_cast<long>(counts.deepest_halving),
                           counts.other_guesses, counts.dissipated_steps})
    row.push_back(static_cast<double>(count));
}

void estimate_values(const Simulation&, const StepCounts& counts, std::size_t, Row& row) {
  row.push_back(counts.error_estimate);
}

/// Names of the columns of a beam, "0/x" to "N/mz".
std::vector<ResultColumn> section_names(const Simulation& simulation, std::size_t link) {
  std::vector<ResultColumn> names;
  for (std::size_t node = 0; node < simulation.undeformed_sections(link, 0).size(); ++node)
    for (const auto& [name, unit] : section_columns()) names.push_back({fmt::format("{}/{}", node, name), unit});
  return names;
}

}  // namespace

const std::vector<ResultColumn>& section_columns() {
  static const std::vector<ResultColumn> columns = {
      {"x", "m"},  {"y", "m"},  {"z", "m"},    {"qx", "1"},   {"qy", "1"},   {"qz", "1"},   {"qw", "1"},
      {"ex", "1"}, {"ey", "1"}, {"ez", "1"},   {"kx", "1/m"}, {"ky", "1/m"}, {"kz", "1/m"}, {"fx", "N"},
      {"fy", "N"}, {"fz", "N"}, {"mx", "N m"}, {"my", "N m"}, {"mz", "N m"}};
  return columns;
}

/// Selects the columns whose names match the patterns.
class ResultColumns::Selection {
 public:
  Selection(ResultColumns& result, const std::vector<std::string>& patterns)
      : result_(result), patterns_(patterns), is_fitted_(patterns.size(), false) {}

  using Names = std::vector<ResultColumn>;  ///< without the prefix
  /// `by_request`: select these columns only if a pattern matches. Without patterns, all other columns are selected.
  void add(const std::string& prefix, const Names& names, Values values, std::size_t index = 0,
           bool by_request = false) {
    Group group{values, index, {}};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string name = prefix + names[k].name;
      names_.push_back(name);
      const int rank = rank_of(name, by_request);
      if (rank == kUnwanted) continue;
      group.taken.push_back({k, found_.size()});
      found_.push_back({{name, names[k].unit}, rank});
    }
    if (!group.taken.empty()) result_.groups_.push_back(group);
  }

  void require_all_fitted() const {
    const auto odd = std::find(is_fitted_.begin(), is_fitted_.end(), false);
    if (odd == is_fitted_.end()) return;
    const std::string& pattern = patterns_[static_cast<std::size_t>(odd - is_fitted_.begin())];
    throw std::invalid_argument(
        fmt::format("no column is like '{}'; there are {}", pattern, nearest_listed(pattern, names_)));
  }

  /// Puts columns in the order of the patterns that select them.
  void put_in_order() {
    std::vector<std::size_t> order(found_.size()), places(found_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t a, std::size_t b) { return found_[a].rank < found_[b].rank; });
    for (std::size_t place = 0; place < order.size(); ++place) {
      places[order[place]] = place;
      result_.columns_.push_back(found_[order[place]].column);
    }
    for (Group& group : result_.groups_)
      for (Taken& taken : group.taken) taken.column = places[taken.column];
    result_.row_.resize(order.size());
  }

 private:
  static constexpr int kFirst = -1, kUnwanted = -2;
  struct Found {
    ResultColumn column;
    int rank;
  };

  /// Index of the first pattern that matches the name, or kFirst, or kUnwanted.
  int rank_of(const std::string& name, bool by_request) {
    int rank = name == "time" || (patterns_.empty() && !by_request) ? kFirst : kUnwanted;
    for (std::size_t i = 0; i < patterns_.size(); ++i) {
      if (fnmatch(patterns_[i].c_str(), name.c_str(), 0) != 0) continue;
      is_fitted_[i] = true;
      if (rank == kUnwanted) rank = static_cast<int>(i);
    }
    return rank;
  }

  ResultColumns& result_;
  const std::vector<std::string>& patterns_;
  std::vector<std::string> names_;  // of all columns that exist
  std::vector<bool> is_fitted_;
  std::vector<Found> found_;
};

ResultColumns::ResultColumns(const Simulation& simulation, Solver solver, const std::vector<std::string>& patterns) {
  using Names = Selection::Names;
  const Names pose = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"qx", "1"}, {"qy", "1"}, {"qz", "1"}, {"qw", "1"}};
  const scene::SceneDescription& scene = simulation.scene();
  Selection selection(*this, patterns);
  selection.add("", {{"time", "s"}}, time_values);
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    const bool turns = is_rotation(model_of(simulation), model_of(simulation).coordinates[i]);
    const std::string prefix = "joint/" + simulation.coordinate_names()[i] + "/";
    selection.add(prefix, {{"position", turns ? "rad" : "m"}}, position_values, i);
    selection.add(prefix, {{"velocity", turns ? "rad/s" : "m/s"}}, velocity_values, i);
    selection.add(prefix, {{"effort", turns ? "N m" : "N"}}, effort_values, i);
  }
  for (std::size_t i = 0; i < simulation.link_names().size(); ++i)
    selection.add("frame/" + simulation.link_names()[i] + "/", pose, frame_values, i);
  for (std::size_t i = 0; i < simulation.link_names().size(); ++i)
    selection.add("beam/" + simulation.link_names()[i] + "/", section_names(simulation, i), section_values, i, true);
  for (std::size_t i = 0; i < scene.probes.size(); ++i) {
    const std::string prefix = "probe/" + scene.probes[i].name + "/";
    selection.add(prefix, pose, probe_values, i);
    selection.add(prefix, {{"vx", "m/s"}, {"vy", "m/s"}, {"vz", "m/s"}}, probe_velocity_values, i);
    selection.add(prefix, {{"ax", "m/s^2"}, {"ay", "m/s^2"}, {"az", "m/s^2"}}, acceleration_values, i, true);
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    Names names;
    for (const auto& [name, unit] : scene::sensor_channels(scene.sensors[i].kind)) names.push_back({name, unit});
    selection.add("sensor/" + scene.sensors[i].name + "/", names, sensor_values, i);
  }
  const ForceElementList& elements = model_of(simulation).force_elements;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i]->name().empty()) continue;
    Names names;
    for (const auto& [name, unit] : elements[i]->outputs()) names.push_back({name, unit});
    selection.add(std::string(elements[i]->kind()) + "/" + elements[i]->name() + "/", names, force_values, i);
  }
  const std::vector<TouchingPair>& pairs = model_of(simulation).touching_pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto names_it = [&](const scene::ContactDescription& contact) {
      return contact.first == pairs[i].first && contact.second == pairs[i].second;
    };
    if (std::none_of(scene.contacts.begin(), scene.contacts.end(), names_it)) continue;
    selection.add("contact/" + pairs[i].first + "/" + pairs[i].second + "/",
                  {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}, {"points", "1"}, {"gap", "m"}}, touch_values, i);
  }
  selection.add(
      "energy/",
      {{"kinetic", "J"}, {"strain", "J"}, {"potential", "J"}, {"total", "J"}, {"work", "J"}, {"dissipated", "J"}},
      energy_values);
  selection.add("momentum/", {{"x", "kg m/s"}, {"y", "kg m/s"}, {"z", "kg m/s"}}, momentum_values);
  selection.add("angular_momentum/", {{"x", "kg m^2/s"}, {"y", "kg m^2/s"}, {"z", "kg m^2/s"}},
                angular_momentum_values);
  if (solver != Solver::Without) {
    selection.add("solver/",
                  {{"step", "s"},
                   {"iterations", "1"},
                   {"halvings", "1"},
                   {"deepest_halving", "1"},
                   {"other_guesses", "1"},
                   {"dissipated_steps", "1"}},
                  solver_values);
    if (solver == Solver::WithEstimate) selection.add("solver/", {{"error_estimate", "m"}}, estimate_values);
  }
  selection.require_all_fitted();
  selection.put_in_order();
}

const std::vector<double>& ResultColumns::row(const Simulation& simulation, const StepCounts& counts) {
  for (const Group& group : groups_) {
    values_.clear();
    group.values(simulation, counts, group.index, values_);
    for (const Taken& taken : group.taken) row_[taken.column] = values_[taken.value];
  }
  return row_;
}

}  // namespace flexarm
