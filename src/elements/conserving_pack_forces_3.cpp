#include "elements/conserving_pack_forces.h"

namespace flexarm::packs {

template decltype(conserving_beam<3>) conserving_beam<3>;
template decltype(carry_strains<3>) carry_strains<3>;

}  // namespace flexarm::packs
