#include "elements/conserving_pack_forces.h"

namespace flexarm::packs {

template decltype(conserving_beam<2>) conserving_beam<2>;

}  // namespace flexarm::packs
