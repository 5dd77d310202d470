#pragma once
/// The properties report: all measurements of all schemes, as Markdown and as data for its picture.

#include <functional>
#include <string>
#include <vector>

#include "bench/conservation.h"
#include "bench/cost.h"
#include "bench/dissipation.h"
#include "bench/dynamic_objectivity.h"
#include "bench/order.h"
#include "bench/path_dependence.h"
#include "bench/robustness.h"
#include "bench/strain_invariance.h"
#include "bench/time_symmetry.h"

namespace flexarm::bench {

/// All that was measured of one scheme with its options.
struct Properties {
  Variant variant;
  Measured<OrderInTime> order;
  Measured<InvariantDrift> drift;
  std::optional<Measured<double>> time_asymmetry;
  double strain_change = 0;
  Measured<double> static_path_dependence;
  Measured<SpinDependence> spin_dependence;
  Measured<DissipationPoint> at_low_frequency, at_high_frequency;
  Measured<Cost> cost;
};

/// What was measured of the schemes with default options only.
struct SchemeReport {
  std::string name;
  std::vector<DissipationPoint> decay;  ///< over dissipation_frequencies()
  std::vector<Robustness> robustness;   ///< over hard_scenes()
};

struct Report {
  std::vector<Properties> rows;
  std::vector<SchemeReport> schemes;
  bool quick = false;
};

/// `progress(part)` is called with the part done, in [0, 1]. `quick`: short runs that show nothing but that they work.
Report measure_properties(bool quick, const std::function<void(double)>& progress);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const Report& report, const std::string& picture);
/// Columns scheme, omega_h, spectral_radius.
std::string decay_to_csv(const Report& report);

}  // namespace flexarm::bench
