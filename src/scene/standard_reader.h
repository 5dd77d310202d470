#pragma once
/// Reads URDF's own elements <link> and <joint>, and flexarm's <loop_joint>. urdfdom reads them too, to warn of faults
/// that other programs would refuse.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <link> without its <beam>, and without shapes that have no extent or that urdfdom cannot read. The name and
/// the location are set even if there are errors.
LinkDescription read_link(const XmlElement& link);

/// Warns of each <collision> of a <link> of <robot> that read_link() leaves out.
void warn_of_untouchable_shapes(const XmlElement& robot);

/// Reads <joint>, except its <clearance>. Names and location are set even if there are errors.
JointDescription read_joint(const XmlElement& joint);

/// Reads <loop_joint>: the children of <joint> except <slide> and <mimic>, and <child_origin>.
JointDescription read_loop_joint(const XmlElement& joint);

/// Reads the children <limit>, <dynamics> and <friction> of an element whose position is a travel without <origin> or
/// <axis>. The kind must be set. Without `lower` and `upper` there are no stops. `positions`: what these must be.
void read_travel(const XmlElement& element, JointDescription& description, const NumberRange& positions);

/// Warns if urdfdom cannot read a <material> of <robot>.
void judge_material(const XmlElement& material);

}  // namespace flexarm::scene
