#pragma once
/// How far stops give way at most (internal to building/).

#include "model/model.h"

namespace flexarm {

/// Sets it for the stops of all limited coordinates: a tenth of the range, of a slider a tenth of the last element.
void set_stop_depths(Model& model);

}  // namespace flexarm
