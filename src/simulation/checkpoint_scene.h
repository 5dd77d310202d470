#pragma once
/// Which scene does a checkpoint belong to?

#include <map>
#include <string>

namespace flexarm {

struct CheckpointScene {
  std::string file;                          ///< absolute path; empty: not known
  std::map<std::string, double> parameters;  ///< values of the scene's parameters
};

/// Whether a file begins as a checkpoint does.
bool is_checkpoint(const std::string& path);

/// @throws std::runtime_error naming the file if it cannot be read or is damaged
CheckpointScene scene_of_checkpoint(const std::string& path);

}  // namespace flexarm
