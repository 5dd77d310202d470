#pragma once
/// A place in a file.

#include <string>

namespace flexarm::scene {

/// Kept for errors that are found only when the model is built.
struct SourceLocation {
  std::string file;
  int line = 0;
};

}  // namespace flexarm::scene
