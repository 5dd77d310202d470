#pragma once
/// Writes the state of a simulation to a file, and reads it back without loss of digits.

#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Writes the state of a simulation as text, with numbers in hexadecimal floating point. A run that is resumed from it
/// continues bit for bit if SimulationOptions::reuse_factorisation is off, otherwise to within Newton's tolerance. The
/// file is written to PATH.partial, synchronised to disk and renamed; an older file stays until then.
/// @throws std::runtime_error naming the file and the reason if it cannot be written.
void write_checkpoint(const Simulation& simulation, const std::string& path);

/// Does everything that write_checkpoint() does except the renaming. Call this before a long run to find out whether
/// its state can be written to this path.
/// @throws std::runtime_error as write_checkpoint().
void try_checkpoint(const Simulation& simulation, const std::string& path);

/// Replaces the simulation's state by that of a file. The scene, the scheme and the step must be those with which the
/// file was written. Newton's tolerance and limits, and probes, may differ. After an error the simulation is unchanged.
/// @throws std::runtime_error naming the file and what is wrong if it cannot be read, is damaged (a checksum detects
/// any flipped bit), belongs to another scene, scheme or step, or contains impossible values.
void read_checkpoint(Simulation& simulation, const std::string& path);

/// The text that write_checkpoint() writes, for storage elsewhere than in a file.
std::string checkpoint_text(const Simulation& simulation);
/// As read_checkpoint(), from a text. Error messages show `name` as the file.
void read_checkpoint_text(Simulation& simulation, const std::string& text, const std::string& name);

}  // namespace flexarm
