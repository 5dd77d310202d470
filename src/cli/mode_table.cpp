#include "cli/mode_table.h"

#include <fmt/format.h>

#include "math/json_text.h"
#include "simulation/csv_fields.h"
#include "simulation/inside.h"
#include "simulation/observables.h"

namespace flexarm::cli {
namespace {

const char* const kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};

ComplexVector6 frame_motion(const Simulation& simulation, const Mode& mode, const Attachment& frame) {
  ComplexVector6 motion = mode.node_motion.at(frame.node);
  const Vector3 arm = attached_pose(state_of(simulation), frame).position -
                      attached_pose(state_of(simulation), {frame.node, Pose()}).position;
  motion.real().head<3>() += motion.real().tail<3>().cross(arm);
  motion.imag().head<3>() += motion.imag().tail<3>().cross(arm);
  return motion;
}

std::string json_complex(const std::string& real, const std::string& imaginary) {
  return "{\"real\": " + real + ", \"imaginary\": " + imaginary + "}";
}

std::string json_motions(const std::vector<NamedMotion>& motions) {
  std::string members;
  for (const auto& [name, motion] : motions)
    append_member(members, name, json_complex(json_array(motion.real()), json_array(motion.imag())));
  return "{" + members + "}";
}

std::string json_mode(const Simulation& simulation, const Mode& mode) {
  std::string joints;
  for (std::size_t i = 0; i < mode.coordinate_motion.size(); ++i) {
    const std::complex<double> motion = mode.coordinate_motion[i];
    append_member(joints, simulation.coordinate_names()[i],
                  json_complex(json_number(motion.real()), json_number(motion.imag())));
  }
  std::string members;
  append_member(members, "frequency", json_number(mode.frequency));
  append_member(members, "rate", json_number(mode.rate));
  append_member(members, "damping_ratio", json_number(mode.damping_ratio()));
  append_member(members, "kind", json_string(kind_of(mode)));
  append_member(members, "joints", "{" + joints + "}");
  append_member(members, "frames", json_motions(frame_motions(simulation, mode)));
  append_member(members, "probes", json_motions(probe_motions(simulation, mode)));
  return "{" + members + "}";
}

void append_csv_names(std::string& line, const std::string& prefix, const std::vector<NamedMotion>& motions) {
  for (const NamedMotion& motion : motions)
    for (const char* part : {"/", "/imaginary/"})
      for (const char* axis : kAxes) csv::append(line, prefix + motion.name + part + axis);
}

void append_csv_values(std::string& line, const std::vector<NamedMotion>& motions) {
  for (const NamedMotion& named : motions) {
    for (int i = 0; i < 6; ++i) csv::append(line, named.motion[i].real());
    for (int i = 0; i < 6; ++i) csv::append(line, named.motion[i].imag());
  }
}

std::string csv_header(const Simulation& simulation, const Mode& mode) {
  std::string line = "mode,frequency,rate,damping_ratio";
  for (const std::string& name : simulation.coordinate_names()) {
    csv::append(line, "joint/" + name);
    csv::append(line, "joint/" + name + "/imaginary");
  }
  append_csv_names(line, "frame/", frame_motions(simulation, mode));
  append_csv_names(line, "probe/", probe_motions(simulation, mode));
  return line;
}

}  // namespace

std::vector<NamedMotion> frame_motions(const Simulation& simulation, const Mode& mode) {
  std::vector<NamedMotion> motions;
  for (const LinkFrame& link : model_of(simulation).links) {
    if (link.frame.node >= 0) motions.push_back({link.name, frame_motion(simulation, mode, link.frame)});
    if (link.beam) motions.push_back({link.name + "/tip", frame_motion(simulation, mode, link.beam->tip)});
  }
  return motions;
}

std::vector<NamedMotion> probe_motions(const Simulation& simulation, const Mode& mode) {
  std::vector<Vector6> real, imaginary;
  for (const ComplexVector6& motion : mode.node_motion) {
    real.push_back(motion.real());
    imaginary.push_back(motion.imag());
  }
  std::vector<NamedMotion> motions;
  for (std::size_t i = 0; i < simulation.scene().probes.size(); ++i) {
    const ProbePoint& point = model_of(simulation).probes[i];
    const ProbeState a = probe_state(model_of(simulation), state_of(simulation), real, point);
    const ProbeState b = probe_state(model_of(simulation), state_of(simulation), imaginary, point);
    NamedMotion motion{simulation.scene().probes[i].name, {}};
    motion.motion.real() << a.velocity, a.angular_velocity;
    motion.motion.imag() << b.velocity, b.angular_velocity;
    motions.push_back(motion);
  }
  return motions;
}

const char* kind_of(const Mode& mode) {
  if (mode.is_free()) return "free";
  if (mode.is_flutter()) return "flutter";
  if (mode.is_divergence()) return "divergence";
  return mode.frequency > 0 ? "oscillation" : "decay";
}

std::string modes_as_json(const Simulation& simulation, const std::vector<Mode>& modes) {
  std::string list;
  for (const Mode& mode : modes) list += (list.empty() ? "\n  " : ",\n  ") + json_mode(simulation, mode);
  return fmt::format("{{\"scene\": {}, \"modes\": [{}]}}\n", json_string(simulation.scene().name), list);
}

std::string modes_as_csv(const Simulation& simulation, const std::vector<Mode>& modes) {
  if (modes.empty()) return "mode,frequency,rate,damping_ratio\n";
  std::string table = csv_header(simulation, modes.front()) + "\n";
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const Mode& mode = modes[i];
    std::string line = fmt::format("{}", i + 1);
    for (const double value : {mode.frequency, mode.rate, mode.damping_ratio()}) csv::append(line, value);
    for (const std::complex<double>& motion : mode.coordinate_motion) {
      csv::append(line, motion.real());
      csv::append(line, motion.imag());
    }
    append_csv_values(line, frame_motions(simulation, mode));
    append_csv_values(line, probe_motions(simulation, mode));
    table += line + "\n";
  }
  return table;
}

}  // namespace flexarm::cli
