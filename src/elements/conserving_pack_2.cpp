#include "elements/conserving_pack_kernels.h"

namespace flexarm::packs {

template decltype(mid_functions<2>) mid_functions<2>;
template decltype(stretch_mid_functions<2>) stretch_mid_functions<2>;
template decltype(element_points<2>) element_points<2>;
template decltype(conserving_beam<2>) conserving_beam<2>;
template decltype(carry_strains<2>) carry_strains<2>;

}  // namespace flexarm::packs
