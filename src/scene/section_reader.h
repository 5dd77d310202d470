#pragma once
/// Reads the cross-section of a <beam>.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads the section of a <beam>. If there is an error, records it and returns nothing.
std::optional<Section> read_section(const XmlElement& beam);

/// Reads the CSV file that `stations` names, relative to the scene's folder. Its first line has the names of the
/// columns. Column `at` is the arc length [m]. The others are either the attributes of <section>, or the upper
/// triangles of the matrices of <section_matrix>: k11, k12, ..., k66 of the stiffness and m11, m12, ..., m66 of the
/// inertia. If there is an error, records it and returns nothing.
std::optional<SectionStations> read_section_table(const XmlElement& stations);

// ---------------------------------------------------------------- checks of a section's matrices

bool is_positive_definite(const Matrix6& matrix);

/// Whether the matrix has the form [[m 1, -m d^], [m d^, J]], with m > 0 and J - m d^T d^, the inertia about the centre
/// of mass, positive semidefinite.
bool is_inertia(const Matrix6& matrix);

}  // namespace flexarm::scene
