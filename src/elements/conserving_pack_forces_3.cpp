#include "elements/conserving_pack_forces.h"

namespace flexarm::packs {

template decltype(conserving_beam<3>) conserving_beam<3>;

}  // namespace flexarm::packs
