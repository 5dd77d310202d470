#pragma once
/// The cross-section of a <beam>.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads the section of a <beam>; nothing if there is an error, which is recorded.
std::optional<Section> read_section(const XmlElement& beam);

/// Reads the CSV file that `stations` names, relative to the scene's folder: a line of names of columns, then numbers.
/// `at` is the arc length; besides it either the attributes of <section>, or the upper triangles k11, k12, ..., k66 of
/// the stiffness and m11, m12, ..., m66 of the inertia of <section_matrix>. Nothing if there is an error, which is
/// recorded.
std::optional<SectionStations> read_section_table(const XmlElement& stations);

// ---------------------------------------------------------------- what matrices of a section must be

bool is_positive_definite(const Matrix6& matrix);

/// [[m 1, -m d^], [m d^, J]] with m > 0 and J - m d^T d^ (about the centre of mass) positive semidefinite.
bool is_inertia(const Matrix6& matrix);

}  // namespace flexarm::scene
