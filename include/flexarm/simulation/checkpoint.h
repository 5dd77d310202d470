#pragma once
/// States as files, bit for bit.

#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Writes the state of a simulation: text, one number per token in hexadecimal floating point, so that a resumed run
/// continues exactly if factors are not reused (SimulationOptions), else to within Newton's tolerance. The file is
/// written beside its place and renamed, never left half-written.
/// @throws std::runtime_error naming the file if it cannot be written.
void write_checkpoint(const Simulation& simulation, const std::string& path);

/// Replaces the simulation's state by one written before from the same model.
/// @throws std::runtime_error naming the file if it cannot be read, is damaged, or belongs to another model or scheme.
void read_checkpoint(Simulation& simulation, const std::string& path);

}  // namespace flexarm
