#include "elements/conserving_pack_kernels.h"

namespace flexarm::packs {

template decltype(mid_functions<4>) mid_functions<4>;
template decltype(stretch_mid_functions<4>) stretch_mid_functions<4>;
template decltype(element_points<4>) element_points<4>;
template decltype(conserving_beam<4>) conserving_beam<4>;
template decltype(carry_strains<4>) carry_strains<4>;

}  // namespace flexarm::packs
