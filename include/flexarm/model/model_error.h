#pragma once
/// Errors of a scene whose file has none.

#include <stdexcept>

namespace flexarm {

/// The scene is impossible as a mechanism, or with its scheme. what() names file, line and element if they are known.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace flexarm
