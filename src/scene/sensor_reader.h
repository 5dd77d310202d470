#pragma once
/// Reads <sensor>.

#include "scene/xml_element.h"

namespace flexarm::scene {

Sensor read_sensor(const XmlElement& sensor);

}  // namespace flexarm::scene
