#pragma once
/// Reads the parameters of a scene, and evaluates the expressions in its attributes.

#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "scene/findings.h"

namespace flexarm::scene {

/// Reads the <parameter>s of <robot>; values in `given` override those of the file. Then replaces every "${expression}"
/// in an attribute of the document by its value; line numbers do not change. Errors are recorded. If a <parameter> or a
/// given value has an error, the expressions are left as they are.
/// @returns the parameters in the order of the file
std::vector<ParameterDescription> expand_parameters(tinyxml2::XMLElement& robot, const ParameterValues& given,
                                                    Findings& findings);

}  // namespace flexarm::scene
