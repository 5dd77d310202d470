#pragma once
/// Writes modes as JSON and CSV, and computes the motions of named places in a mode.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// Complex displacement [m] and rotation [rad] of a place in a mode, world axes.
struct NamedMotion {
  std::string name;
  ComplexVector6 motion;
};
/// The motions of the frame of every link that can move ("arm"), and of every flexible link's tip ("arm/tip").
std::vector<NamedMotion> frame_motions(const Simulation& simulation, const Mode& mode);
std::vector<NamedMotion> probe_motions(const Simulation& simulation, const Mode& mode);

/// The kind of a mode: "free", "oscillation", "decay", "flutter" or "divergence".
const char* kind_of(const Mode& mode);

/// One JSON object, `{"scene": NAME, "modes": [...]}`. A mode has frequency [Hz], rate [1/s], damping_ratio, kind, and
/// the real and imaginary parts of the motions of each joint coordinate (one number), frame and probe (x y z rx ry rz).
/// Numbers have 17 significant digits.
std::string modes_as_json(const Simulation& simulation, const std::vector<Mode>& modes);
/// A header, and one line for each mode, with the columns
///   mode, frequency, rate, damping_ratio
///   joint/NAME, joint/NAME/imaginary             for every free coordinate
///   frame/NAME/x|y|z|rx|ry|rz, then /imaginary   for every frame (NAME or NAME/tip); likewise probe/NAME/...
std::string modes_as_csv(const Simulation& simulation, const std::vector<Mode>& modes);

}  // namespace flexarm::cli
