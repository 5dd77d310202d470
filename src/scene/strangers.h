#pragma once
/// Elements of a scene that are not read here: of other programs, or written wrongly.

#include "scene/force_element_kinds.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

/// Records, as warnings, children of <robot> that neither flexarm nor, as far as is known, another program uses, each
/// name once, with the name that is probably meant. Elements with a namespace ("drake:...") are left alone. `kinds`: of
/// force elements that are read here.
void warn_of_strangers(const XmlElement& robot, const std::vector<ForceElementKind>& kinds);

/// Records, as warnings, joints inside <gazebo> between two links that no joint of the scene joins: they close loops
/// for Gazebo alone.
void warn_of_gazebo_loops(const XmlElement& robot, const SceneDescription& scene);

}  // namespace flexarm::scene
