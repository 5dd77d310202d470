#include <algorithm>

#include "flexarm/scene/tendon.h"
#include "scene/readers.h"
#include "scene/standard_reader.h"

namespace flexarm::scene {
namespace {

/// Lets a winch pay out a tendon. The scene shares tendons with its copies, so the tendon is replaced.
void connect(const std::string& reel, std::shared_ptr<const ForceElementDescription>& element) {
  auto tendon = std::make_shared<TendonDescription>(dynamic_cast<const TendonDescription&>(*element));
  tendon->reels.push_back(reel);
  element = std::move(tendon);
}

}  // namespace

ForceElementDescriptions::iterator find_tendon(SceneDescription& scene, const std::string& name) {
  return std::find_if(scene.force_elements.begin(), scene.force_elements.end(), [&](const auto& element) {
    return std::string_view(element->kind()) == "tendon" && element->name == name;
  });
}

ReadWinch read_winch(const XmlElement& unnamed) {
  ReadWinch out;
  out.travel.name = unnamed.name("name").value_or("");
  out.travel.location = unnamed.location();
  out.travel.kind = JointKind::Prismatic;
  const XmlElement winch = unnamed.with_name(out.travel.name);
  winch.expect_only({"name", "tendon"}, {"limit", "dynamics", "friction", "spring", "drive", "servo"});
  winch.expect_at_most_one({"spring", "drive", "servo"});
  out.tendon = winch.name("tendon").value_or("");
  read_travel(winch, out.travel, kAnyNumber);
  return out;
}

void add_winches(const std::vector<ReadWinch>& winches, SceneDescription& scene, Findings& findings) {
  for (const ReadWinch& winch : winches) {
    const auto error = [&](const std::string& expected, const std::string& got) {
      findings.error(winch.travel.location.line, "<winch> " + quoted(winch.travel.name), expected, quoted(got));
    };
    const std::string link = winch.travel.name + "_reel";
    const auto is_taken = [&](const auto& things, const std::string& name) {
      return std::any_of(things.begin(), things.end(), [&](const auto& thing) { return thing.name == name; });
    };
    if (is_taken(scene.joints, winch.travel.name) || is_taken(scene.loop_joints, winch.travel.name)) {
      error("the name of its coordinate is taken by a joint", winch.travel.name);
      continue;
    }
    if (is_taken(scene.links, link)) {
      error("the name of its reel is taken by a link", link);
      continue;
    }
    const auto tendon = find_tendon(scene, winch.tendon);
    if (tendon == scene.force_elements.end()) {
      if (!winch.tendon.empty()) error("tendon must be the name of a <tendon>", winch.tendon);
      continue;
    }
    if (dynamic_cast<const TendonDescription&>(**tendon).tension)
      error("a tendon of given tension has no length to pay out: give it ea", winch.tendon);
    connect(link, *tendon);
    JointDescription travel = winch.travel;
    travel.parent = scene.root_link;
    travel.child = link;
    scene.links.push_back({link, {}, {}, {}, {}, winch.travel.location});
    scene.joints.push_back(travel);
  }
}

}  // namespace flexarm::scene
