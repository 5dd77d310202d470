#pragma once
/// Readers of single XML elements of a scene. They record errors in the element's Findings. The readers of <link> and
/// <joint> are in standard_reader.h, those of forces between points of links in force_element_kinds.h.

#include <set>
#include <string>
#include <vector>

#include "scene/hydraulics_reader.h"
#include "scene/start.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- children of <link>

/// Reads <beam>. Returns nothing if there is an error.
std::optional<BeamDescription> read_beam(const XmlElement& beam, const std::string& link);

/// Reads <drag> of a link that has been read apart from it. Returns nothing if there is an error.
std::optional<DragDescription> read_drag(const XmlElement& drag, const LinkDescription& link);

// ---------------------------------------------------------------- children of <joint>

/// Reads <couple>, which makes the travel of a joint a function of its angle. Sets the joint's kind and data. The axis
/// and <slide> must have been read before.
void read_couple(const XmlElement& joint, const XmlElement& couple, JointDescription& description);

/// Reads <slide> of a joint that moves along its parent's flexible centreline. Sets the joint's kind and data, except
/// its axes.
void read_slide(const XmlElement& joint, const XmlElement& slide, JointDescription& description);

/// Reads <friction> into `description`, whose kind must be set.
void read_friction(const XmlElement& friction, JointDescription& description);

/// Reads <clearance>. `description`: the joint, read as if it had no play.
ClearanceDescription read_clearance(const XmlElement& clearance, const XmlElement& joint,
                                    const JointDescription& description);
/// Turns a joint with play into a floating joint, which represents it in the tree of joints.
void free_play(JointDescription& joint);

// ---------------------------------------------------------------- children of <robot>

/// A cylinder, and the joint between its barrel and its rod.
struct ReadCylinder {
  CylinderDescription cylinder;
  JointDescription travel;
  std::optional<ReadHydraulics> hydraulics;
};
/// Reads <cylinder> without its children <spring>, <drive> and <servo>, and those of its pump. The name and the
/// location are set even if there are errors.
ReadCylinder read_cylinder(const XmlElement& cylinder);
/// Adds cylinders and their parts to the scene, whose other links and joints must be complete. Names of cylinders with
/// errors, and those of their parts, are added to `unreadable`.
void add_cylinders(const std::vector<ReadCylinder>& cylinders, SceneDescription& scene,
                   std::set<std::string>& unreadable, Findings& findings);

SpringDescription read_spring(const XmlElement& spring);
DriveDescription read_drive(const XmlElement& drive);
ServoDescription read_servo(const XmlElement& servo);

/// A URDF <transmission> between one motor and one joint.
struct Transmission {
  std::string joint;
  std::string reduction;  ///< text of <mechanicalReduction>
  int line = 0;
};
/// Reads <transmission>. Returns nothing if it has no <mechanicalReduction>, or several joints or motors.
std::optional<Transmission> read_transmission(const XmlElement& transmission);

/// Gives drives without a gear ratio the reduction of their joint's transmission. One warning lists all drives whose
/// own ratio differs from that reduction.
void settle_gears(const std::vector<Transmission>& transmissions, std::vector<DriveDescription>& drives,
                  Findings& findings);

/// A winch, whose coordinate is the travel of a reel without inertia.
struct ReadWinch {
  JointDescription travel;  ///< without its links
  std::string tendon;
};
/// Reads <winch> without its children <spring>, <drive> and <servo>.
ReadWinch read_winch(const XmlElement& winch);
/// Adds for each winch a joint on the scene's root link, which must be settled, that carries a reel, the link
/// NAME_reel, and lets that pay out the winch's tendon. The scene's other links, joints and tendons must be complete.
void add_winches(const std::vector<ReadWinch>& winches, SceneDescription& scene, Findings& findings);
/// The same for the pumps of cylinders. The scene's other links, joints and cylinders must be complete.
void add_pumps(const std::vector<ReadCylinder>& cylinders, SceneDescription& scene, Findings& findings);

Sensor read_sensor(const XmlElement& sensor);
/// Gives sensors of tendons their link: that of the first guide.
void connect_tendon_sensors(SceneDescription& scene, Findings& findings);

GroundDescription read_ground(const XmlElement& ground);
/// Reads the attributes `xyz` and `rpy` of <origin>, <child_origin> or the like.
Pose read_pose(const XmlElement& origin);
/// Reads the attributes `contact_time` and `stiffness` of stops, contacts or play, of which at most one may be given.
void read_hardness(const XmlElement& element, std::optional<double>& contact_time, std::optional<double>& stiffness);
/// Reads the attributes `restitution` and `speeds` of a contact.
RestitutionDescription read_restitution(const XmlElement& element);
/// Whether a child of <robot> is flexarm's <contact>. A <contact> of other programs has neither `first` nor `second`.
bool is_contact(const XmlElement& element);
ContactDescription read_contact(const XmlElement& contact);
ContactPair read_no_contact(const XmlElement& pair);
/// Reads <no_contact srdf="">: returns the pairs of links whose collisions that SRDF file disables.
std::vector<ContactPair> read_srdf(const XmlElement& no_contact);
/// Reads friction and contact stiffness of a link from <gazebo reference="">, if it has any.
void read_surface(const XmlElement& gazebo, SceneDescription& scene);
/// Checks that contacts name links or grounds of the scene, and that no pair is named twice.
void check_contacts(const SceneDescription& scene, Findings& findings);
/// Adds pairs from SRDF files to the scene's <no_contact>s. Skips pairs with links that the scene lacks, and pairs for
/// which the scene has a <contact> or <no_contact>.
void add_disabled_pairs(const std::vector<ContactPair>& pairs, SceneDescription& scene);

/// Reads <simulation> into `scene`, and the initial state that it asks for into `start` (see start.h). Names are
/// not checked here (see check_references()).
void read_simulation(const XmlElement& simulation, SceneDescription& scene, StartRequest& start);

}  // namespace flexarm::scene
