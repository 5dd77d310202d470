#include "model/prestrain.h"

#include "model/model.h"

namespace flexarm {

Vector6 prestrain_at(const Model& model, int index, double time) {
  Vector6 strain = Vector6::Zero();
  if (index < 0) return strain;
  const Prestrain& prestrain = model.prestrains[index];
  for (int i = 0; i < 6; ++i)
    if (const int history = prestrain.histories[i]; history >= 0) strain[i] = model.histories[history](time);
  // r_c = r + Lambda c, hence Gamma_c = Gamma - c x K.
  strain.head<3>() -= prestrain.centroid.cross(strain.tail<3>());
  return strain;
}

}  // namespace flexarm
