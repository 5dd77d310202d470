#include "scene/force_element_kinds.h"

#include "scene/bushing_reader.h"
#include "scene/point_spring_reader.h"
#include "scene/tendon_reader.h"

namespace flexarm::scene {

const std::vector<ForceElementKind>& force_element_kinds() {
  static const std::vector<ForceElementKind> kinds = {
      {"bushing", "", read_bushing}, {"spring", "from", read_point_spring}, {"tendon", "", read_tendon}};
  return kinds;
}

}  // namespace flexarm::scene
