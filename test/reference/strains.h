#pragma once
/// Indices of strains, in the order in which a beam's description has its data per strain.

namespace flexarm::test {

enum Strain { kAxial, kShearY, kShearZ, kTorsion, kBendingY, kBendingZ };

}  // namespace flexarm::test
