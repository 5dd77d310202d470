#pragma once
/// Reads <ground>, <contact> and <no_contact> of <robot>.

#include "flexarm/scene/contact_description.h"
#include "flexarm/scene/scene_description.h"
#include "scene/findings.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

GroundDescription read_ground(const XmlElement& ground);
/// Whether a <contact> of <robot> is ours: others' have no sides.
bool is_contact(const XmlElement& element);
ContactDescription read_contact(const XmlElement& contact);
ContactPair read_no_contact(const XmlElement& pair);
/// Checks that names refer to something and that no pair is named twice.
void check_contacts(const SceneDescription& scene, Findings& findings);

}  // namespace flexarm::scene
