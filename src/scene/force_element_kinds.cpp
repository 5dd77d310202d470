#include "scene/force_element_kinds.h"

#include "scene/bushing_reader.h"
#include "scene/point_spring_reader.h"
#include "scene/tendon_reader.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

const std::vector<ForceElementKind>& force_element_kinds() {
  static const std::vector<ForceElementKind> kinds = {
      {"bushing", "", read_bushing}, {"spring", "from", read_point_spring}, {"tendon", "", read_tendon}};
  return kinds;
}

void read_ends(const XmlElement& element, BetweenTwoPoints& out) {
  out.location = element.location();
  if (element.has("name")) out.name = element.name("name").value_or("");
  out.from = element.name("from").value_or("");
  out.from_at = element.vector("from_at", out.from_at);
  out.to = element.name("to").value_or("");
  out.to_at = element.vector("to_at", out.to_at);
}

LinkChange BetweenTwoPoints::change_links(const LinkChanges& change) {
  LinkChange first = change(from);
  const LinkChange second = change(to);
  from = first.name, from_at = first.frame * from_at;
  to = second.name, to_at = second.frame * to_at;
  return first;
}

}  // namespace flexarm::scene
