#pragma once
/// Poses, a contact law and random vectors for tests of contacts with a beam's line.

#include <random>
#include <vector>

#include "support/gripping_law.h"
#include "support/node_poses.h"

namespace flexarm::test::lines {

using Poses = std::vector<NodePose>;

inline ContactLaw gripping_law(double friction, double restitution) {
  return test::gripping_law(friction, restitution, 0.4);
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Braces guarantee that the numbers are drawn in the same order with every compiler.
  Vector3 vector(double size) { return size * Vector3{number_(engine_), number_(engine_), number_(engine_)}; }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> number_{-1, 1};
};

}  // namespace flexarm::test::lines
