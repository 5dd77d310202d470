#pragma once
/// States as files, bit for bit.

#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Writes the state of a simulation as text, with numbers in hexadecimal floating point. So a resumed run continues
/// exactly if factors are not reused (SimulationOptions), otherwise to within Newton's tolerance. The file is written
/// to PATH.partial, synchronised to disk and renamed; the file of before stays until then.
/// @throws std::runtime_error naming the file and the reason if it cannot be written.
void write_checkpoint(const Simulation& simulation, const std::string& path);

/// Does all that write_checkpoint() does except the renaming. With it a long simulation finds out before it begins
/// whether its state can be written there.
/// @throws std::runtime_error as write_checkpoint().
void try_checkpoint(const Simulation& simulation, const std::string& path);

/// Replaces the simulation's state by one that was written with the same scene, scheme and step. Newton's tolerance and
/// limits, and probes, may differ. After an error the simulation is as before.
/// @throws std::runtime_error naming the file and what is wrong if it cannot be read, is damaged (a checksum tells any
///   flipped bit), belongs to another scene, scheme or step, or has values that no state has.
void read_checkpoint(Simulation& simulation, const std::string& path);

/// The text that write_checkpoint() writes, to keep states elsewhere than in files.
std::string checkpoint_text(const Simulation& simulation);
/// As read_checkpoint(), from text; `name` stands for the file in errors.
void read_checkpoint_text(Simulation& simulation, const std::string& text, const std::string& name);

}  // namespace flexarm
