#pragma once
/// Elements of a scene that act between points of links: the base of all kinds.

#include <memory>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/source_location.h"

namespace flexarm {

class ForceElement;
struct NodePoint;

namespace scene {

/// A point of a link, as an attribute of the scene's element names it.
struct LinkPoint {
  std::string attribute;         ///< for messages: "from"
  std::string link;              ///< empty: wrong in the file
  Vector3 at = Vector3::Zero();  ///< in the undeformed link frame [m]
};

/// An element of the scene that acts between points of links. Constant once it is part of a scene: copies share it.
class ForceElementDescription {
 public:
  virtual ~ForceElementDescription() = default;

  /// The name of its element: "spring".
  virtual const char* kind() const = 0;
  virtual std::vector<LinkPoint> points() const = 0;
  /// All its numbers except those of its points: two elements with the same numbers do the same.
  virtual std::vector<double> numbers() const = 0;
  /// Makes the element of the mechanism. `places`: of its points; `positions`: of its points at the start, in the world
  /// [m].
  virtual std::shared_ptr<const ForceElement> place(const std::vector<NodePoint>& places,
                                                    const std::vector<Vector3>& positions) const = 0;

  std::string name;  ///< of its columns; empty: it has none
  SourceLocation location = {};
};

using ForceElementDescriptions = std::vector<std::shared_ptr<const ForceElementDescription>>;

}  // namespace scene
}  // namespace flexarm
