#pragma once
/// Contacts with the smooth lines of beams, for contact_builder.cpp.

#include <string>
#include <vector>

#include "building/contact_laws.h"
#include "building/scene_plan.h"
#include "contact/line_contact.h"
#include "model/model.h"

namespace flexarm {

/// Two links, by their indices in the plan, and their names. `is_reversed`: the names are in the opposite order of the
/// indices.
struct LinkPair {
  int first = 0, second = 0;
  std::vector<std::string> names;
  bool is_reversed = false;
};

/// Whether a ball is tested against the line of a beam, and not the beam's stations against the ball. That is so if the
/// ball is smaller than an element, since it would fall between the stations. A beam may wrap around larger balls.
bool touches_line(double ball_radius, const BeamLink& beam);
/// Whether corners are tested against the line of a beam, too: its own stations, which are tested against faces, are
/// then far apart.
bool has_room_for_corners(const BeamLink& beam, int most_spans);

/// Adds contacts of the stations of a body, given for each of its nodes, with the line of the second link.
void join_with_line(const Model& model, const ScenePlan& plan, const LinkPair& links,
                    const std::vector<ContactStations>& bodies, const ContactLaw& law, ForceElementList& placed);
/// Adds contacts of the lines of two beams with each other, both ways; or of one beam with itself.
void join_lines(const Model& model, const ScenePlan& plan, const LinkPair& links, const ContactLaw& law,
                ForceElementList& placed);

}  // namespace flexarm
