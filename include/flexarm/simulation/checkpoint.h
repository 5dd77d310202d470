#pragma once
/// States as files, bit for bit.

#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Writes the state of a simulation: text, one number per token in hexadecimal floating point, so that a resumed run
/// continues exactly if factors are not reused (SimulationOptions), else to within Newton's tolerance. The file is
/// written beside its place (PATH.partial), synchronised to disk and renamed: what was there before stays until then.
/// @throws std::runtime_error naming the file and the reason if it cannot be written.
void write_checkpoint(const Simulation& simulation, const std::string& path);

/// Does all that write_checkpoint() does but for the last: what is there stays. A long simulation can so find out
/// before it begins that its state cannot be kept there.
/// @throws std::runtime_error as write_checkpoint().
void try_checkpoint(const Simulation& simulation, const std::string& path);

/// Replaces the simulation's state by one written before from the same scene, scheme and step. Newton's tolerance and
/// limits, and probes, may be others. On an error the simulation is as before.
/// @throws std::runtime_error naming the file and what is wrong if it cannot be read, is damaged (a checksum tells any
///   flipped bit), belongs to another scene, scheme or step, or has values that no state has.
void read_checkpoint(Simulation& simulation, const std::string& path);

/// What write_checkpoint() writes, for who keeps states elsewhere than in files.
std::string checkpoint_text(const Simulation& simulation);
/// As read_checkpoint(), from text; `name` stands for the file in errors.
void read_checkpoint_text(Simulation& simulation, const std::string& text, const std::string& name);

}  // namespace flexarm
