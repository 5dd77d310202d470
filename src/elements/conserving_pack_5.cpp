#include "elements/conserving_pack_kernels.h"

namespace flexarm::packs {

template decltype(mid_functions<5>) mid_functions<5>;
template decltype(stretch_mid_functions<5>) stretch_mid_functions<5>;
template decltype(element_points<5>) element_points<5>;
template decltype(conserving_beam<5>) conserving_beam<5>;
template decltype(carry_strains<5>) carry_strains<5>;

}  // namespace flexarm::packs
