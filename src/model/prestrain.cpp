#include "model/prestrain.h"

#include <cassert>

#include "model/model.h"

namespace flexarm {

namespace {

template <class Value>
Vector6 centroid_strain(const Model& model, int index, const Value& value) {
  assert(index < static_cast<int>(model.prestrains.size()));
  Vector6 strain = Vector6::Zero();
  if (index < 0) return strain;
  const Prestrain& prestrain = model.prestrains[index];
  for (int i = 0; i < 6; ++i)
    if (const int history = prestrain.histories[i]; history >= 0) strain[i] = value(model.histories[history]);
  // From the reference line to the centroid c: r_c = r + Lambda c, hence Gamma_c = Gamma - c x K.
  strain.head<3>() -= prestrain.centroid.cross(strain.tail<3>());
  return strain;
}

}  // namespace

Vector6 prestrain_at(const Model& model, int index, double time) {
  return centroid_strain(model, index, [&](const TimeFunction& history) { return history(time); });
}

Vector6 mean_prestrain(const Model& model, int index, double begin, double end) {
  return centroid_strain(model, index, [&](const TimeFunction& history) { return history.mean(begin, end); });
}

}  // namespace flexarm
