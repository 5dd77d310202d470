#pragma once
/// Sections of a beam as a table, as data of blades and booms come.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads the CSV file that `stations` names, relative to the scene's folder: a line of names of columns, then numbers.
/// `at` is the arc length; besides it either the attributes of <section>, or the upper triangles k11, k12, ..., k66 of
/// the stiffness and m11, m12, ..., m66 of the inertia of <section_matrix>. Nothing if there is an error, which is
/// recorded.
std::optional<SectionStations> read_section_table(const XmlElement& stations);

}  // namespace flexarm::scene
