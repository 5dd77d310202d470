#include <algorithm>

#include <fmt/format.h>

#include "flexarm/scene/tendon.h"
#include "scene/readers.h"
#include "scene/scene_names.h"
#include "scene/standard_reader.h"

namespace flexarm::scene {
namespace {

/// Lets a winch pay out a tendon. The scene shares tendons with its copies, so the tendon is replaced.
void connect(const std::string& reel, std::shared_ptr<const ForceElementDescription>& element) {
  auto tendon = std::make_shared<TendonDescription>(dynamic_cast<const TendonDescription&>(*element));
  tendon->reels.push_back(reel);
  element = std::move(tendon);
}

/// Whether the name of a reel's coordinate or link is taken; if so, records an error.
bool is_reel_taken(const JointDescription& travel, const char* tag, const SceneDescription& scene, Findings& findings) {
  const auto is_taken = [&](const auto& things, const std::string& name) {
    return std::any_of(things.begin(), things.end(), [&](const auto& thing) { return thing.name == name; });
  };
  const bool is_joint_taken = is_taken(scene.joints, travel.name) || is_taken(scene.loop_joints, travel.name);
  const std::string link = reel_of(travel.name);
  if (!is_joint_taken && !is_taken(scene.links, link)) return false;
  findings.error(
      travel.location.line, fmt::format("<{}> {}", tag, quoted(travel.name)),
      is_joint_taken ? "the name of its coordinate is taken by a joint" : "the name of its reel is taken by a link",
      quoted(is_joint_taken ? travel.name : link));
  return true;
}

/// Adds a reel without inertia, whose travel is the coordinate of a winch or a pump.
void add_reel(JointDescription travel, SceneDescription& scene) {
  travel.parent = scene.root_link;
  travel.child = reel_of(travel.name);
  scene.links.push_back({travel.child, {}, {}, {}, {}, travel.location});
  scene.joints.push_back(std::move(travel));
}

}  // namespace

std::string reel_of(const std::string& coordinate) {
  return coordinate + "_reel";
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
    if (is_reel_taken(winch.travel, "winch", scene, findings)) continue;
    const std::size_t tendon = find_force_element(scene, "tendon", winch.tendon);
    if (tendon == scene.force_elements.size()) {
      if (!winch.tendon.empty())
        error("tendon must be the name of a <tendon>" +
                  findings.candidates(winch.tendon, force_element_names(scene, "tendon")),
              winch.tendon);
      continue;
    }
    if (dynamic_cast<const TendonDescription&>(*scene.force_elements[tendon]).tension)
      error("a tendon of given tension has no length to pay out: give it ea", winch.tendon);
    connect(reel_of(winch.travel.name), scene.force_elements[tendon]);
    add_reel(winch.travel, scene);
  }
}

void add_pumps(const std::vector<ReadCylinder>& cylinders, SceneDescription& scene, Findings& findings) {
  for (const ReadCylinder& read : cylinders) {
    const std::size_t index = find_force_element(scene, "cylinder", read.cylinder.name);
    if (index == scene.force_elements.size() || read.cylinder.pump.empty()) continue;
    const JointDescription& travel = *read.hydraulics->pump;
    if (is_reel_taken(travel, "pump", scene, findings)) continue;
    auto& element = scene.force_elements[index];
    auto oil = std::make_shared<HydraulicsDescription>(dynamic_cast<const HydraulicsDescription&>(*element));
    oil->reel = reel_of(travel.name);
    element = std::move(oil);
    add_reel(travel, scene);
  }
}

}  // namespace flexarm::scene
