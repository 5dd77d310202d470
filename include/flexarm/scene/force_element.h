#pragma once
/// Base class of the elements of a scene that act between points of links, such as springs.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/math/time_function.h"
#include "flexarm/scene/source_location.h"

namespace flexarm {

class ForceElement;
struct NodePoint;
struct NodePose;

namespace scene {

/// The attribute of a LinkPoint that is the reel of a winch.
constexpr const char* kReel = "winch";

/// A point of a link, as given by an attribute of an XML element.
struct LinkPoint {
  std::string attribute;         ///< name of the attribute, for messages: "from"
  std::string link;              ///< empty if the file has an error there
  Vector3 at = Vector3::Zero();  ///< in the undeformed link frame [m]
};

/// Where the points of an element are in the model.
struct ForcePlacement {
  std::vector<NodePoint> places;                 ///< per point: node and offset
  std::vector<Vector3> positions;                ///< per point: initial position in the world [m]
  std::vector<int> functions = {};               ///< indices of functions() in the model
  const std::vector<NodePose>* nodes = nullptr;  ///< initial poses of all nodes
  Vector3 origin = Vector3::Zero();              ///< of positions, in the world [m]
};

/// What becomes of a link when its scene becomes a part of another one.
struct LinkChange {
  std::string name;
  Pose frame;  ///< of its former frame in the new one
};
using LinkChanges = std::function<LinkChange(const std::string& link)>;

/// An XML element of the scene that acts between points of links. Copies of a scene share it, so it must not change
/// once it is part of a scene.
class ForceElementDescription {
 public:
  virtual ~ForceElementDescription() = default;

  /// The name of the XML element: "spring".
  virtual const char* kind() const = 0;
  virtual std::vector<LinkPoint> points() const = 0;
  /// Functions of time that the element uses.
  virtual std::vector<TimeFunction> functions() const { return {}; }
  /// All parameters except points and functions. Two elements of one kind with the same numbers behave alike.
  virtual std::vector<double> numbers() const = 0;
  /// Returns a copy that acts between the same points after links have changed.
  virtual std::shared_ptr<ForceElementDescription> with_links(const LinkChanges& change) const = 0;
  /// Creates the force element of the model.
  virtual std::shared_ptr<const ForceElement> place(const ForcePlacement& placement) const = 0;

  std::string name;  ///< used in the names of result columns; empty: no columns
  SourceLocation location = {};
};

/// An element between a point of one link and a point of another one.
class BetweenTwoPoints : public ForceElementDescription {
 public:
  std::string from, to;                                        ///< names of links
  Vector3 from_at = Vector3::Zero(), to_at = Vector3::Zero();  ///< in the undeformed link frames [m]

  std::vector<LinkPoint> points() const override { return {{"from", from, from_at}, {"to", to, to_at}}; }

 protected:
  /// Moves the points as the links change. @returns the change of `from`
  LinkChange change_links(const LinkChanges& change);
};

using ForceElementDescriptions = std::vector<std::shared_ptr<const ForceElementDescription>>;

}  // namespace scene
}  // namespace flexarm
