#include "elements/conserving_pack_tangent.h"

namespace flexarm::packs {

template decltype(add_tangent<5>) add_tangent<5>;

}  // namespace flexarm::packs
