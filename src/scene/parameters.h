#pragma once
/// Parameters of a scene, and the expressions of them in its attributes.

#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Reads the <parameter>s of <robot>, `given` values being in the place of the file's, and replaces every
/// "${expression}" in an attribute by its number: whoever reads the document then, finds no expressions, and lines as
/// they were. What is wrong is recorded; then expressions are left.
/// @returns the parameters in the order of the file
std::vector<ParameterDescription> expand_parameters(tinyxml2::XMLElement& robot, const ParameterValues& given,
                                                    Findings& findings);

}  // namespace flexarm::scene
