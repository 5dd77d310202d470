#include "bench/hard_group.h"

#include <stdexcept>

namespace flexarm::bench {
namespace {

std::function<Vector3(const Simulation&)> observe_probe() {
  return [](const Simulation& simulation) { return simulation.probe(0).pose.position; };
}

std::function<Vector3(const Simulation&)> observe_coordinate(const std::string& name) {
  return [name](const Simulation& simulation) { return Vector3(position_of(simulation, name), 0, 0); };
}

}  // namespace

double position_of(const Simulation& simulation, const std::string& coordinate) {
  return simulation.position(simulation.find_coordinate(coordinate).value());
}

Target probe_at(const Vector3& expected, double scale, double tolerance) {
  return {"closed form", observe_probe(), scale, tolerance, expected, "", 0};
}

Target probe_by_step(double step, double scale, double tolerance) {
  return {"finer run", observe_probe(), scale, tolerance, std::nullopt, "", step};
}

Target coordinate_at(const std::string& coordinate, double expected, double scale, double tolerance) {
  return {"closed form", observe_coordinate(coordinate), scale, tolerance, Vector3(expected, 0, 0), "", 0};
}

Target coordinate_by_run(const std::string& coordinate, const std::string& scene, double step, double scale,
                         double tolerance) {
  return {"other run", observe_coordinate(coordinate), scale, tolerance, std::nullopt, scene, step};
}

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  add_beam_cases(cases);
  add_motion_cases(cases);
  add_slider_cases(cases);
  add_joint_cases(cases);
  add_mechanism_cases(cases);
  add_static_cases(cases);
  add_contact_cases(cases);
  add_line_cases(cases);
  return cases;
}

}  // namespace flexarm::bench
