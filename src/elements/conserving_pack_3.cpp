#include "elements/conserving_pack_kernels.h"

namespace flexarm::packs {

template decltype(mid_functions<3>) mid_functions<3>;
template decltype(stretch_mid_functions<3>) stretch_mid_functions<3>;
template decltype(element_points<3>) element_points<3>;
template decltype(conserving_beam<3>) conserving_beam<3>;
template decltype(carry_strains<3>) carry_strains<3>;

}  // namespace flexarm::packs
