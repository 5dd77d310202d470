#include "building/contact_laws.h"

#include <algorithm>
#include <cmath>

#include "math/pi.h"

namespace flexarm {
namespace {

/// The stiffness of sticking friction is at most this times that of a contact of the given contact time.
constexpr double kStiffestGrip = 1600 / (kPi * kPi);

}  // namespace

ContactLaw law_of_points(const LawRequest& request) {
  const double frequency = kPi / request.contact_time;
  ContactLaw law;
  const double usual = request.mass * frequency * frequency / request.at_a_time;
  law.stiffness = request.stiffness.value_or(std::min(usual, request.softest));
  law.frequency = std::sqrt(law.stiffness * request.at_a_time / request.mass);
  law.restitution = {request.restitution.values, request.restitution.speeds};
  law.friction = request.friction;
  law.grip = std::min(request.grip * law.stiffness, kStiffestGrip * usual);
  return law;
}

double mass_of_body(const Model& model, int node) {
  if (node < 0) return std::numeric_limits<double>::infinity();
  const double mass = model.inertias[node].total_mass;
  return mass > 0 ? mass : mass_of(model);
}

void allow_start(ContactLaw& law, double deepest) {
  law.most_start = std::min(kStartInside * law.depth, kThrownOut / law.frequency);
  law.depth = std::max(law.depth, deepest / kStartInside);
}

double deepest_start(const Model& model, const ContactStations& side, const ContactSurface& surface) {
  const SeenStations seen(side, surface, poses_in(model.nodes));
  double deepest = -std::numeric_limits<double>::infinity();
  for (const ContactStation& station : side.stations)
    for (const ContactShape& shape : surface.shapes) {
      const int face = seen.face(station, shape, 0);
      const StationPlace place = seen.place(station, shape, face);
      const double radius = station.radius - place.rise;
      const double start = start_inside(shape, {}, radius, place.point(), seen.outwards(station), face).start;
      deepest = std::max(deepest, start > 0 ? start : radius - shape.gap(place.point()));
    }
  return deepest;
}

}  // namespace flexarm
