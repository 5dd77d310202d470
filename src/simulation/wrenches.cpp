#include "simulation/wrenches.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "simulation/entry.h"

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
  const LinkFrame& link = entry(model.links, wrench.link, "link");
  const auto& [force, moment] = wrench.wrench;
  if (!wrench.at.allFinite() || !force.allFinite() || !moment.allFinite())
    throw std::invalid_argument(fmt::format("the wrench on link '{}' is not finite", link.name));
  const Pull& pull = wrench.pull;
  if (!pull.target.allFinite() || !std::isfinite(pull.stiffness) || !std::isfinite(pull.damping))
    throw std::invalid_argument(fmt::format("the pull on link '{}' is not finite", link.name));
  if (pull.stiffness < 0 || pull.damping < 0)
    throw std::invalid_argument(fmt::format("the pull on link '{}' has stiffness {} N/m and damping {} N s/m, not >= 0",
                                            link.name, pull.stiffness, pull.damping));
  if (link.frame.node < 0) throw std::invalid_argument(fmt::format("link '{}' is fixed to the world", link.name));
  const Attachment carrier = carrier_of(model, link, wrench.at);
  NodalLoad load = load_on(carrier.node, carrier.offset, wrench.at, force, moment, wrench.follows);
  load.pull = pull;
  load.link = static_cast<int>(wrench.link);
  return load;
}

void require_no_pulls(const Scheme& scheme, const std::vector<NodalLoad>& wrenches) {
  const auto pulls = [](const NodalLoad& wrench) { return wrench.pull.acts(); };
  if (scheme.hht != HhtForm::None && std::any_of(wrenches.begin(), wrenches.end(), pulls))
    throw std::invalid_argument("schemes that interpolate forces in time (hht1, hht2, hht3) have no pulls");
}

}  // namespace flexarm
