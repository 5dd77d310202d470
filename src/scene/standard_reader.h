#pragma once
/// URDF's own <link> and <joint>: numbers are checked here, line by line; values come from urdfdom.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <link> without its <beam>. The name and the location are set even if there are errors.
LinkDescription read_link(const XmlElement& link);

/// Reads <joint> with its <release> and <axis2>. Names and location are set even if there are errors.
JointDescription read_joint(const XmlElement& joint);

/// Reads <loop_joint>: the same elements, less <slide> and <mimic>, and <child_origin>.
JointDescription read_loop_joint(const XmlElement& joint);

/// Has urdfdom read `element` as a child of <robot>; its complaints become a finding about the element.
void check_with_urdfdom(const XmlElement& element);

}  // namespace flexarm::scene
