#include "building/link_mesh.h"

#include <stdexcept>

#include "flexarm/model/model_error.h"

namespace flexarm {

std::string at(const scene::SourceLocation& location, const std::string& element) {
  return location.file + ":" + std::to_string(location.line) + ": " + element + ": ";
}

Centreline centreline_of(const scene::LinkDescription& link) {
  const scene::BeamDescription& beam = *link.beam;
  if (beam.order < 1 || beam.order > 4) throw ModelError(at(beam.location, "<beam>") + "order must be 1 to 4");
  try {
    return Centreline(beam.centreline, beam.section_y);
  } catch (const std::invalid_argument& error) {
    throw ModelError(at(beam.location, "<centerline> of link '" + link.name + "'") + error.what());
  }
}

BeamMesh mesh_of(const scene::LinkDescription& link, const Centreline& centreline, const std::vector<double>& borders,
                 int most) {
  try {
    return mesh_beam(*link.beam, centreline, borders, most);
  } catch (const std::invalid_argument& error) {
    throw ModelError(at(link.beam->location, "<beam> of link '" + link.name + "'") + error.what());
  }
}

std::vector<double> ends_of(const scene::DistributedLoad& load, const Centreline& centreline) {
  std::vector<double> ends;
  for (const std::optional<double>& end : {load.from, load.to}) {
    if (!end) continue;
    if (*end > centreline.length())
      throw ModelError(at(load.location, "<distributed_load>") + "the line of link '" + load.link + "' is " +
                       std::to_string(centreline.length()) + " m long, got " + std::to_string(*end));
    ends.push_back(*end);
  }
  return ends;
}

}  // namespace flexarm
