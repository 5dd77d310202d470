#pragma once
/// Helpers to write lists of hard cases: cases are added to groups, with the results that correct runs have.

#include <optional>
#include <string>
#include <vector>

#include "bench/hard.h"

namespace flexarm::bench {

/// Adds cases of one group to a list.
class HardGroup {
 public:
  HardGroup(std::vector<HardCase>& cases, std::string name) : cases_(cases), name_(std::move(name)) {}

  /// Adds a case; `step`, `until` [s]. The returned case may be changed until the next one is added.
  HardCase& add(const std::string& name, const std::string& scene, double step, double until,
                const std::optional<Target>& target = {}) {
    HardCase hard;
    hard.group = name_;
    hard.name = name;
    hard.scene = scene;
    hard.step = step;
    hard.until = until;
    hard.target = target;
    cases_.push_back(std::move(hard));
    return cases_.back();
  }
  void add_bounded(const std::string& name, const std::string& scene, double step, double until, const Bound& bound) {
    add(name, scene, step, until).bound = bound;
  }
  /// See HardCase::is_free.
  void add_free(const std::string& name, const std::string& scene, double step, double until) {
    add(name, scene, step, until).is_free = true;
  }
  /// See HardCase::is_sound.
  void add_unsound(const std::string& name, const std::string& scene, double step, double until) {
    add(name, scene, step, until).is_sound = false;
  }
  HardCase& add_static(const std::string& name, const std::string& scene, int load_steps,
                       const std::optional<Target>& target = {}) {
    HardCase& hard = add(name, scene, 1e-3, 0, target);
    hard.load_steps = load_steps;
    return hard;
  }

 private:
  std::vector<HardCase>& cases_;
  std::string name_;
};

/// Position of a coordinate, which must exist [rad or m].
double position_of(const Simulation& simulation, const std::string& coordinate);

/// A target for the position of the only probe at the end, by a closed form [m].
Target probe_at(const Vector3& expected, double scale, double tolerance);
/// The same, by a reference run with another step [s].
Target probe_by_step(double step, double scale, double tolerance);
/// A target for a coordinate at the end, by a closed form [rad or m].
Target coordinate_at(const std::string& coordinate, double expected, double scale, double tolerance);
/// The same, by a reference run of `scene` with its own step [s]; an empty scene: that of the case.
Target coordinate_by_run(const std::string& coordinate, const std::string& scene, double step, double scale,
                         double tolerance);

// The groups, each defined in a file by its subject.
void add_beam_cases(std::vector<HardCase>& cases);
void add_motion_cases(std::vector<HardCase>& cases);
void add_slider_cases(std::vector<HardCase>& cases);
void add_joint_cases(std::vector<HardCase>& cases);
void add_mechanism_cases(std::vector<HardCase>& cases);
void add_contact_cases(std::vector<HardCase>& cases);
void add_line_cases(std::vector<HardCase>& cases);
void add_static_cases(std::vector<HardCase>& cases);

}  // namespace flexarm::bench
