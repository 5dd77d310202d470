#pragma once
/// Modes as tables for other programs, and the motions of named places in them.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// Displacement [m] and rotation [rad] of a place, world axes.
struct NamedMotion {
  std::string name;
  ComplexVector6 motion;
};
/// Of every link's frame that can move ("arm") and every flexible link's tip ("arm/tip").
std::vector<NamedMotion> frame_motions(const Simulation& simulation, const Mode& mode);
std::vector<NamedMotion> probe_motions(const Simulation& simulation, const Mode& mode);

/// "free", "oscillation", "decay", "flutter" or "divergence".
const char* kind_of(const Mode& mode);

/// One object, `{"scene": NAME, "modes": [...]}`. A mode has frequency [Hz], rate [1/s], damping_ratio, kind, and for
/// every joint coordinate, frame and probe the real and the imaginary part of its motion (a number, or x y z rx ry rz).
/// Numbers have 17 significant digits.
std::string modes_as_json(const Simulation& simulation, const std::vector<Mode>& modes);
/// A header and one line for each mode, with the columns
///   mode, frequency, rate, damping_ratio
///   joint/NAME, joint/NAME/imaginary             for every released coordinate
///   frame/NAME/x|y|z|rx|ry|rz, then /imaginary   for every frame (NAME or NAME/tip), probe/NAME alike
std::string modes_as_csv(const Simulation& simulation, const std::vector<Mode>& modes);

}  // namespace flexarm::cli
