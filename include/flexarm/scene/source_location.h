#pragma once
/// Where something stands in a file.

#include <string>

namespace flexarm::scene {

/// Kept for errors that only the model builder can find.
struct SourceLocation {
  std::string file;
  int line = 0;
};

}  // namespace flexarm::scene
