#pragma once
/// A line of an input file.

#include <string>

namespace flexarm::scene {

/// The line where an element of the scene was read. Errors that are found only when the model is built refer to it.
struct SourceLocation {
  std::string file;
  int line = 0;
};

}  // namespace flexarm::scene
