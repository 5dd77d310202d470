// Tests shapes that can touch: distances, their derivatives, and points of contact.
#include "contact/shape.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "contact/point_contact.h"
#include "math/so3.h"
#include "support/polytopes.h"

namespace flexarm::test {
namespace {

const Pose kPlace{{0.3, -0.2, 0.5}, so3::exp_quaternion(Vector3(0.4, -0.7, 0.2))};

struct Named {
  const char* name;
  ContactShape shape;
};
std::vector<Named> all_shapes() {
  return {{"half-space", {HalfSpace{}, kPlace}},
          {"ball", {Ball{0.4}, kPlace}},
          {"box", {Box{{0.3, 0.5, 0.2}}, kPlace}},
          {"cylinder", {Cylinder{0.3, 0.5}, kPlace}},
          {"tube", {Tube{0.6, 0.35, 0.5}, kPlace}},
          {"socket", {Ball{0.4}, kPlace, true}},
          {"bearing", {Cylinder{0.3, std::numeric_limits<double>::infinity()}, kPlace, true}},
          {"hull", {Hull{std::make_shared<Polytope>(roof_polytope({0.3, 0.4, 0.2}, 0.15))}, kPlace}}};
}

std::vector<Vector3> random_points(int count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Vector3> out;
  for (int i = 0; i < count; ++i)
    out.push_back(kPlace * Vector3(number(generator), number(generator), number(generator)));
  return out;
}

// Differences with steps of 1e-6 and 1e-4 have errors of the squares of these, except where a face ends within the
// step.
TEST(ContactShapes, HaveTheDerivativesOfTheirDistances) {
  for (const auto& [name, shape] : all_shapes()) {
    int wrong = 0;
    for (const Vector3& point : random_points(300)) {
      const SignedDistance here = shape.distance(point);
      EXPECT_NEAR(here.gradient.norm(), 1, 1e-14) << name;
      bool is_right = true;
      for (int k = 0; k < 3; ++k) {
        const Vector3 h = 1e-6 * Vector3::Unit(k);
        const SignedDistance more = shape.distance(point + h), less = shape.distance(point - h);
        is_right = is_right && std::abs((more.value - less.value) / 2e-6 - here.gradient[k]) < 1e-8 &&
                   ((more.gradient - less.gradient) / 2e-6 - here.hessian.col(k)).norm() < 1e-7;
      }
      wrong += !is_right;
    }
    EXPECT_EQ(wrong, 0) << name;
  }
}

// Compares a box with its hull, outside and inside, with all derivatives. Where two faces or edges are equally near,
// either one may count.
TEST(ContactShapes, ThatAreHullsOfBoxesAreTheBoxes) {
  const Vector3 half(0.3, 0.5, 0.2);
  const ContactShape box{Box{half}, kPlace}, hull{Hull{std::make_shared<Polytope>(box_polytope(half))}, kPlace};
  for (const Vector3& point : random_points(500)) {
    const SignedDistance one = box.distance(point), other = hull.distance(point);
    EXPECT_NEAR(one.value, other.value, 1e-14);
    EXPECT_NEAR((one.gradient - other.gradient).norm(), 0, 1e-12);
    EXPECT_NEAR((one.hessian - other.hessian).norm(), 0, 1e-12 * (1 + one.hessian.norm()));
    EXPECT_LE(hull.gap(point), one.value + 1e-14);
    EXPECT_EQ(nearest_face(box, point), nearest_face(hull, point));
  }
  EXPECT_EQ(contact_points(box, 0.1, false).size(), contact_points(hull, 0.1, false).size());
  EXPECT_NEAR(half_width(hull), half_width(box), 1e-15);
}

TEST(ContactShapes, TouchAPlaneByThePointsOfAFace) {
  const auto count = [](const ContactShape& shape, double spacing) {
    return points_at_a_time(shape, contact_points(shape, spacing, false));
  };
  EXPECT_EQ(count({Ball{0.1}, kPlace}, 1), 1);
  EXPECT_EQ(count({Box{{0.3, 0.2, 0.1}}, kPlace}, 10), 4);
  EXPECT_EQ(count({Box{{0.3, 0.2, 0.1}}, kPlace}, 0.2), 4 + 2 * 2 + 2 * 1) << "the largest has most";
  EXPECT_EQ(count({Cylinder{0.1, 0.05}, kPlace}, 1), kRimPoints);
  EXPECT_EQ(count({Hull{std::make_shared<Polytope>(roof_polytope({0.3, 0.4, 0.2}, 0.15))}, kPlace}, 10), 5);
}

// Compares the distance with that of the nearest of many surface points. The tolerance is the distance between these
// points.
TEST(ContactShapes, AreAsFarAsTheirSurfaces) {
  const Box box{{0.3, 0.5, 0.2}};
  const Cylinder cylinder{0.3, 0.5};
  const Tube tube{0.6, 0.35, 0.5};
  const ContactShape shapes[] = {{box, Pose()}, {cylinder, Pose()}, {tube, Pose()}};
  constexpr int kCount = 120;
  for (const ContactShape& shape : shapes) {
    std::vector<Vector3> surface;
    for (int i = 0; i <= kCount; ++i)
      for (int j = 0; j <= kCount; ++j) {
        const double u = -1 + 2.0 * i / kCount, v = -1 + 2.0 * j / kCount, angle = 4 * std::atan(1.0) * u;
        for (const double side : {-1.0, 1.0}) {
          if (std::holds_alternative<Box>(shape.kind)) {
            surface.push_back(box.half.cwiseProduct(Vector3(side, u, v)));
            surface.push_back(box.half.cwiseProduct(Vector3(u, side, v)));
            surface.push_back(box.half.cwiseProduct(Vector3(u, v, side)));
          } else {
            const bool has_bore = std::holds_alternative<Tube>(shape.kind);
            const double outer = has_bore ? tube.radius : cylinder.radius, bore = has_bore ? tube.inner_radius : 0;
            const Vector3 radial(std::cos(angle), std::sin(angle), 0), along(0, 0, v * cylinder.half_length);
            surface.push_back(outer * radial + along);
            if (has_bore) surface.push_back(bore * radial + along);
            surface.push_back((bore + 0.5 * (v + 1) * (outer - bore)) * radial +
                              Vector3(0, 0, side * cylinder.half_length));
          }
        }
      }
    for (const Vector3& point : random_points(40)) {
      double nearest = 1e9;
      for (const Vector3& each : surface) nearest = std::min(nearest, (each - point).norm());
      EXPECT_NEAR(std::abs(shape.distance(point).value), nearest, 0.012);
      // The point at the end of the gradient is on the surface.
      const SignedDistance here = shape.distance(point);
      EXPECT_NEAR(shape.distance(point - here.value * here.gradient).value, 0, 1e-14);
    }
  }
}

TEST(ContactShapes, HaveTheirPointsOnTheirSurfaces) {
  for (const auto& [name, shape] : all_shapes())
    for (const ContactPoint& point : contact_points(shape, 0.15, false))
      EXPECT_NEAR(shape.distance(point.arm).value, -point.radius, 1e-15) << name;
}

// Inside a hole, the gradient points to its middle. There is nothing to pass through between two points in a hole.
TEST(ContactShapes, AreHolesTurnedInsideOut) {
  for (const ContactShape& hole :
       {ContactShape{Ball{0.4}, kPlace, true}, ContactShape{Cylinder{0.4, 9}, kPlace, true}}) {
    ContactShape solid = hole;
    solid.is_hollow = false;
    for (const Vector3& point : random_points(20)) {
      EXPECT_EQ(hole.gap(point), -solid.gap(point));
      EXPECT_NEAR(hole.distance(point).value, hole.gap(point), 1e-15);
      EXPECT_GT((kPlace.position - point).dot(hole.distance(point).gradient), 0);
    }
    EXPECT_FALSE(has_faces(hole));
    EXPECT_TRUE(contact_points(hole, 0.1, false).empty());
    EXPECT_FALSE(passes_through(hole, kPlace * Vector3(0.3, 0, 0), kPlace * Vector3(-0.3, 0.1, 0), 0.01));
  }
}

// In the middle of a shape the gradient is a unit vector, so that a penetrating point is pushed out in some direction.
TEST(ContactShapes, HaveADirectionInTheirMiddles) {
  for (const auto& [name, shape] : all_shapes()) {
    const SignedDistance here = shape.distance(kPlace.position);
    EXPECT_NEAR(here.gradient.norm(), 1, 1e-15) << name;
    EXPECT_TRUE(here.hessian.allFinite()) << name;
  }
}

}  // namespace
}  // namespace flexarm::test
