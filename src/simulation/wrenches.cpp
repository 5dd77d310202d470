#include "simulation/wrenches.h"

#include <stdexcept>

#include <fmt/format.h>

namespace flexarm {
namespace {

/// The link's frame as seen from the node that carries the point.
Attachment carrier_of(const Model& model, const LinkFrame& link, const Vector3& point) {
  if (!link.beam) return link.frame;
  const auto pose = [&](int node) { return Pose{model.nodes[node].position, model.nodes[node].orientation}; };
  const Pose origin = pose(link.frame.node) * link.frame.offset;
  const Vector3 place = origin.position + origin.orientation * point;
  int nearest = link.frame.node;
  for (int node = nearest + 1; node <= link.beam->tip.node; ++node)
    if ((model.nodes[node].position - place).norm() < (model.nodes[nearest].position - place).norm()) nearest = node;
  return {nearest, pose(nearest).inverse() * origin};
}

}  // namespace

NodalLoad placed_wrench(const Model& model, const AppliedWrench& wrench) {
  const LinkFrame& link = model.links.at(wrench.link);
  const auto& [force, moment] = wrench.wrench;
  if (!wrench.at.allFinite() || !force.allFinite() || !moment.allFinite())
    throw std::invalid_argument(fmt::format("the wrench on link '{}' is not finite", link.name));
  if (link.frame.node < 0) throw std::invalid_argument(fmt::format("link '{}' is fixed to the world", link.name));
  const Attachment carrier = carrier_of(model, link, wrench.at);
  return load_on(carrier.node, carrier.offset, wrench.at, force, moment, wrench.follows);
}

}  // namespace flexarm
