#include "elements/conserving_pack_tangent.h"

namespace flexarm::packs {

template decltype(add_tangent<4>) add_tangent<4>;

}  // namespace flexarm::packs
