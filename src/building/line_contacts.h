#pragma once
/// Contacts with the smooth lines of beams, for contact_builder.cpp.

#include <string>
#include <vector>

#include "building/contact_laws.h"
#include "building/scene_plan.h"
#include "contact/line_contact.h"
#include "model/model.h"

namespace flexarm {

/// Of two links by their index among the plan's, the names of both; `is_reversed`: the other way round.
struct LinkPair {
  int first = 0, second = 0;
  std::vector<std::string> names;
  bool is_reversed = false;
};

/// Whether what has these stations touches the line of a beam, and not the beam's stations it. A small ball does, or
/// else it would fall between these: that is true of one that is smaller than an element. Larger ones may be embraced.
bool touches_line(double ball_radius, const BeamLink& beam);
/// Whether corners touch the line of a beam, too: where its own stations, which look for faces, are far from each
/// other.
bool has_room_for_corners(const BeamLink& beam, int most_spans);

/// Stations of a body, of each of its nodes, against the line of the second link.
void join_with_line(const Model& model, const ScenePlan& plan, const LinkPair& links,
                    const std::vector<ContactStations>& bodies, const ContactLaw& law, ForceElementList& placed);
/// Lines of two beams against each other, both ways; of one beam against itself.
void join_lines(const Model& model, const ScenePlan& plan, const LinkPair& links, const ContactLaw& law,
                ForceElementList& placed);

}  // namespace flexarm
