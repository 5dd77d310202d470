#include "scene/xacro.h"

#include <algorithm>
#include <string_view>

namespace flexarm::scene {
namespace {

constexpr const char* kUnread[] = {"visual", "collision", "material", "gazebo", "transmission"};

bool is_macro(std::string_view tag) {
  return tag.substr(0, 6) == "xacro:";
}

/// "${...}" or "$(arg ...)" and the like, which xacro replaces.
bool has_substitution(std::string_view value) {
  return value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos;
}

bool refuse(const XmlElement& element, int line, std::string_view got) {
  element.findings().error(
      line, element.description(),
      "this is xacro and must be expanded to URDF first, where the robot's package and xacro are installed: "
      "xacro FILE.xacro > FILE.urdf",
      quoted(got));
  return true;
}

bool refuse_element(const XmlElement& element) {
  const std::string tag = element.tag();
  if (is_macro(tag)) return refuse(element, element.line(), tag);
  if (std::find(std::begin(kUnread), std::end(kUnread), tag) != std::end(kUnread)) return false;
  for (const tinyxml2::XMLAttribute* a = element.xml().FirstAttribute(); a; a = a->Next())
    if (has_substitution(a->Value())) return refuse(element, a->GetLineNum(), a->Value());
  const std::vector<XmlElement> children = element.children();
  return std::any_of(children.begin(), children.end(), refuse_element);
}

}  // namespace

bool refuse_xacro(const XmlElement& robot) {
  return refuse_element(robot);
}

}  // namespace flexarm::scene
