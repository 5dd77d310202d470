#pragma once
/// URDF's own <link> and <joint>: read and checked line by line; urdfdom tells what other programs make of them.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <link> without its <beam>. The name and the location are set even if there are errors.
LinkDescription read_link(const XmlElement& link);

/// Reads <joint> with its <release> and <axis2>. Names and location are set even if there are errors.
JointDescription read_joint(const XmlElement& joint);

/// Reads <loop_joint>: the same elements, less <slide> and <mimic>, and <child_origin>.
JointDescription read_loop_joint(const XmlElement& joint);

/// Records what urdfdom finds wrong with a <material> of the robot.
void judge_material(const XmlElement& material);

}  // namespace flexarm::scene
