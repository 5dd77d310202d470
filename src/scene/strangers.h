#pragma once
/// Warns of elements and attributes of a scene that flexarm does not read: misspelt ones, and loops that only Gazebo
/// closes.

#include "scene/force_element_kinds.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

/// Whether an element outside <simulation> is meant as an entry of it: it has the tag of one, and names a joint or a
/// link.
bool belongs_in_simulation(const XmlElement& element);

/// Warns of children of <robot> that neither flexarm nor any known program reads. There is one warning for each name,
/// and it suggests the name that is probably meant. Elements with a namespace ("drake:...") are skipped. `kinds`: the
/// kinds of force elements that flexarm reads.
void warn_of_strangers(const XmlElement& robot, const std::vector<ForceElementKind>& kinds);

/// Warns of names within <link>, <joint>, <loop_joint> and <material> that are almost the name of an element or
/// attribute that URDF has there. URDF's readers, urdfdom among them, ignore such names without a word, and the link
/// has no mass then, or the joint no origin. Other names are left alone: they belong to other programs. There is one
/// warning for each name in one kind of element.
void warn_of_misspelt_words(const XmlElement& robot);

/// Warns of joints inside <gazebo> between two links that no joint of the scene connects: they close loops only in
/// Gazebo.
void warn_of_gazebo_loops(const XmlElement& robot, const SceneDescription& scene);

}  // namespace flexarm::scene
