#include "elements/conserving_pack_forces.h"

namespace flexarm::packs {

template decltype(conserving_beam<4>) conserving_beam<4>;

}  // namespace flexarm::packs
