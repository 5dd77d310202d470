#pragma once
/// The order in which a beam's description has something for each strain.

namespace flexarm::test {

enum Strain { kAxial, kShearY, kShearZ, kTorsion, kBendingY, kBendingZ };

}  // namespace flexarm::test
