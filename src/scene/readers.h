#pragma once
/// Readers of single elements of a scene; what is wrong is recorded. Those of <link> and <joint> are in
/// standard_reader.h, those of what acts between points in force_element_kinds.h.

#include "scene/start.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- of <link>

/// Reads <beam>; nothing if there is an error.
std::optional<BeamDescription> read_beam(const XmlElement& beam, const std::string& link);

// ---------------------------------------------------------------- of <joint>

/// Reads <couple>, which lets the travel depend on the angle: kind and data of the joint. Its axis, and that it is a
/// slide, must have been read.
void read_couple(const XmlElement& joint, const XmlElement& couple, JointDescription& description);

/// Reads <slide> of a joint that rides on its parent's flexible centreline: kind and data of the joint, all but its
/// axes.
void read_slide(const XmlElement& joint, const XmlElement& slide, JointDescription& description);

/// Reads <friction> into `description`, whose kind is known.
void read_friction(const XmlElement& friction, JointDescription& description);

/// Reads <clearance> of a joint that has been read as if it had no play.
ClearanceDescription read_clearance(const XmlElement& clearance, const XmlElement& joint,
                                    const JointDescription& description);
/// Makes a joint with play what it is in the tree: a floating one.
void free_play(JointDescription& joint);

// ---------------------------------------------------------------- of <robot>

SpringDescription read_spring(const XmlElement& spring);
DriveDescription read_drive(const XmlElement& drive);
ServoDescription read_servo(const XmlElement& servo);

/// The reduction between one motor and one joint.
struct Transmission {
  std::string joint;
  std::string reduction;  ///< as it is written
  int line = 0;
};
/// Nothing where it has no <mechanicalReduction>, or couples several joints or motors.
std::optional<Transmission> read_transmission(const XmlElement& transmission);

/// Drives without a gear take that of their joint's transmission; one warning names those with another one.
void settle_gears(const std::vector<Transmission>& transmissions, std::vector<DriveDescription>& drives,
                  Findings& findings);

Sensor read_sensor(const XmlElement& sensor);

GroundDescription read_ground(const XmlElement& ground);
/// Whether a <contact> of <robot> is ours: others' have no sides.
bool is_contact(const XmlElement& element);
ContactDescription read_contact(const XmlElement& contact);
ContactPair read_no_contact(const XmlElement& pair);
/// Pairs that an SRDF beside the scene disables, of <no_contact srdf="">.
std::vector<ContactPair> read_srdf(const XmlElement& no_contact);
/// What <gazebo reference=""> says of a link's surface, if anything.
void read_surface(const XmlElement& gazebo, SceneDescription& scene);
/// Checks that names of contacts refer to something, and that no pair is named twice.
void check_contacts(const SceneDescription& scene, Findings& findings);
/// Adds those pairs of SRDFs that the scene has links for, and says nothing of.
void add_disabled_pairs(const std::vector<ContactPair>& pairs, SceneDescription& scene);

/// Reads <simulation> into `scene`, and what it says about the start into `start`, which is settled later. So are
/// names.
void read_simulation(const XmlElement& simulation, SceneDescription& scene, StartRequest& start);

}  // namespace flexarm::scene
