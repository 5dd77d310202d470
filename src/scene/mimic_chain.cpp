#include "scene/scene_checks.h"

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

namespace flexarm::scene {
namespace {

/// Share of a follower's range by which its master's limits may let it go beyond this range without a warning. Elastic
/// stops give way by more.
constexpr double kRounded = 0.01;

/// A joint that mimics another one, directly or through a chain: position = offset + multiplier * position of `master`.
/// The master is the end of the chain: it mimics no joint.
struct Follower {
  const JointDescription* joint;
  const JointDescription* master;
  double multiplier, offset;
};

/// Returns the followers in the order of the joints. Leaves out those whose chain ends at an unknown joint or is a
/// ring.
std::vector<Follower> followers_of(const std::vector<JointDescription>& joints) {
  std::unordered_map<std::string, const JointDescription*> named;
  for (const JointDescription& joint : joints) named.emplace(joint.name, &joint);
  std::unordered_map<const JointDescription*, const JointDescription*> masters;  // null: unknown
  for (const JointDescription& joint : joints) {
    if (!joint.mimic) continue;
    const auto found = named.find(joint.mimic->joint);
    masters.emplace(&joint, found == named.end() ? nullptr : found->second);
  }
  std::vector<Follower> followers;
  for (const JointDescription& joint : joints) {
    if (!joint.mimic) continue;
    Follower follower{&joint, &joint, 1, 0};
    for (std::size_t passed = 0; follower.master && follower.master->mimic && passed < joints.size(); ++passed) {
      const Mimic& mimic = *follower.master->mimic;
      follower.offset += follower.multiplier * mimic.offset;
      follower.multiplier *= mimic.multiplier;
      follower.master = masters.at(follower.master);
    }
    if (follower.master && !follower.master->mimic) followers.push_back(follower);
  }
  return followers;
}

/// Warns about a follower whose own limits the motion of its master may exceed. A master without limits may go
/// anywhere.
void check_range(const Follower& follower, Findings& findings) {
  const std::optional<JointLimits>& own = follower.joint->limits;
  const std::optional<JointLimits>& limits = follower.master->limits;
  const bool is_still = follower.multiplier == 0 || follower.master->kind == JointKind::Fixed;
  if (!own || own->lower > own->upper || (limits && limits->lower > limits->upper)) return;
  std::string reach = "which has no limits";
  if (is_still || limits) {
    const double factor = is_still ? 0 : follower.multiplier, from = limits ? limits->lower : 0,
                 to = limits ? limits->upper : 0;
    const auto [least, most] = std::minmax({follower.offset + factor * from, follower.offset + factor * to});
    const double rounded = kRounded * (own->upper - own->lower);
    if (least >= own->lower - rounded && most <= own->upper + rounded) return;
    reach = fmt::format("which lets it go from {} to {}", least, most);
  }
  findings.warning(
      follower.joint->location.line, "<joint> " + quoted(follower.joint->name),
      fmt::format("its own limits are not kept, since it follows {} alone, {}", quoted(follower.master->name), reach),
      fmt::format("'{}' to '{}'", own->lower, own->upper));
}

}  // namespace

void check_followers(const SceneDescription& scene, Findings& findings) {
  for (const Follower& follower : followers_of(scene.joints)) {
    if (follower.master->kind == JointKind::Fixed)
      findings.warning(follower.joint->location.line, "<joint> " + quoted(follower.joint->name),
                       fmt::format("is held at {}, since the joint that it mimics is fixed", follower.offset),
                       quoted(follower.master->name));
    check_range(follower, findings);
  }
}

void hold_followers_of_fixed_joints(SceneDescription& scene) {
  for (const Follower& follower : followers_of(scene.joints))
    if (follower.master->kind == JointKind::Fixed)
      scene.motions.push_back(
          {follower.joint->name, TimeFunction::parse(fmt::format("{}", follower.offset)), follower.joint->location});
}

}  // namespace flexarm::scene
