#pragma once
/// The constant pi.

namespace flexarm {

constexpr double kPi = 3.14159265358979323846;

}  // namespace flexarm
