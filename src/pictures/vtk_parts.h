#pragma once
/// What files for ParaView show at one instant, part by part. docs/results.md lists their arrays.

#include <memory>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "pictures/picture.h"
#include "pictures/vtk_file.h"

namespace flexarm::pictures {

/// A part of a scene. Its points may change from instant to instant, its arrays do not.
class VtkPart {
 public:
  explicit VtkPart(std::string name) : name_(std::move(name)) {}
  virtual ~VtkPart() = default;

  const std::string& name() const { return name_; }
  /// The present state.
  virtual VtkPolyData show(const Simulation& simulation) = 0;

 private:
  std::string name_;
};

/// Lines of beams, surfaces of rigid links, lines of springs and tendons, and wrenches. A scene that has none of them
/// has empty parts.
/// @param picture  of the simulation; only for this call
std::vector<std::unique_ptr<VtkPart>> vtk_parts(const Simulation& simulation, const Picture& picture);

}  // namespace flexarm::pictures
