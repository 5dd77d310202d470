#include "elements/conserving_pack_forces.h"

namespace flexarm::packs {

template decltype(conserving_beam<5>) conserving_beam<5>;

}  // namespace flexarm::packs
