#pragma once
/// Errors that are found when a mechanism is built from a scene whose file was read without errors.

#include <stdexcept>

namespace flexarm {

/// The scene is impossible as a mechanism, or does not work with its scheme. what() names the file, line and element if
/// they are known.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexarm
