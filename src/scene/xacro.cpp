#include "scene/xacro.h"

#include <algorithm>
#include <string_view>

namespace flexarm::scene {
namespace {

constexpr const char* kHint =
    "this is xacro and must be expanded to URDF first, where the robot's package and xacro are installed: "
    "xacro FILE.xacro > FILE.urdf";
constexpr const char* kUnread[] = {"visual", "collision", "material", "gazebo", "transmission"};

bool is_macro(std::string_view tag) {
  return tag.substr(0, 6) == "xacro:";
}

/// "$(arg ...)" and the like, which xacro replaces. Expressions "${...}" scenes have, too (parameters.h).
bool has_substitution(std::string_view value) {
  return value.find("$(") != std::string_view::npos;
}

bool refuse(const XmlElement& element, int line, std::string_view got) {
  element.findings().error(line, element.description(), kHint, quoted(got));
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

void refuse_property(const XmlElement& element, int line, const std::string& parameter, std::string_view got) {
  element.findings().error(line, element.description(),
                           std::string(kHint) + "; or a scene's <parameter name=\"" + parameter + "\"> is missing",
                           quoted(got));
}

}  // namespace flexarm::scene
