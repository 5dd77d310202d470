#pragma once
/// Gauss-Legendre quadrature on the parent interval [-1, 1].

#include <array>

namespace flexarm {

/// Abscissae in increasing order and weights; exact for polynomials of degree 2 Points - 1.
template <int Points>
struct GaussLegendre;

template <>
struct GaussLegendre<1> {
  static constexpr std::array<double, 1> points{0.0};
  static constexpr std::array<double, 1> weights{2.0};
};

template <>
struct GaussLegendre<2> {
  static constexpr std::array<double, 2> points{-0.57735026918962576450914878050196,
                                                0.57735026918962576450914878050196};
  static constexpr std::array<double, 2> weights{1.0, 1.0};
};

template <>
struct GaussLegendre<3> {
  static constexpr std::array<double, 3> points{-0.77459666924148337703585307995648, 0.0,
                                                0.77459666924148337703585307995648};
  static constexpr std::array<double, 3> weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
};

template <>
struct GaussLegendre<4> {
  static constexpr std::array<double, 4> points{-0.86113631159405257522394648889281,
                                                -0.33998104358485626480266575910324, 0.33998104358485626480266575910324,
                                                0.86113631159405257522394648889281};
  static constexpr std::array<double, 4> weights{0.34785484513745385737306394922200, 0.65214515486254614262693605077800,
                                                 0.65214515486254614262693605077800,
                                                 0.34785484513745385737306394922200};
};

template <>
struct GaussLegendre<5> {
  static constexpr std::array<double, 5> points{-0.90617984593866399279762687829939,
                                                -0.53846931010568309103631442070021, 0.0,
                                                0.53846931010568309103631442070021, 0.90617984593866399279762687829939};
  static constexpr std::array<double, 5> weights{0.23692688505618908751426404071992, 0.47862867049936646804129151483564,
                                                 128.0 / 225.0, 0.47862867049936646804129151483564,
                                                 0.23692688505618908751426404071992};
};

}  // namespace flexarm
