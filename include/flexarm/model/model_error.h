#pragma once
/// What is wrong with a scene that is well-formed as a file.

#include <stdexcept>

namespace flexarm {

/// A scene that is impossible as a mechanism, or with its scheme; what() names file, line and element where there are.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexarm
