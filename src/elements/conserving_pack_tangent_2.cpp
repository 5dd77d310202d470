#include "elements/conserving_pack_tangent.h"

namespace flexarm::packs {

template decltype(add_tangent<2>) add_tangent<2>;

}  // namespace flexarm::packs
