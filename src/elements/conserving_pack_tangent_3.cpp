#include "elements/conserving_pack_tangent.h"

namespace flexarm::packs {

template decltype(add_tangent<3>) add_tangent<3>;

}  // namespace flexarm::packs
