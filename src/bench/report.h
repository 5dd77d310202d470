#pragma once
/// The properties report: measurements of all schemes, as Markdown, and as data for its plot.

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

/// All measurements of one scheme with certain options.
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

/// Measurements that are made for schemes with default options only.
struct SchemeReport {
  std::string name;
  std::vector<DissipationPoint> decay;  ///< for each of dissipation_frequencies()
  std::vector<Robustness> robustness;   ///< for each of hard_scenes()
};

struct Report {
  std::vector<Properties> rows;
  std::vector<SchemeReport> schemes;
  bool quick = false;
};

/// `progress(part)` is called with the completed fraction, in [0, 1]. `quick`: short runs as a test of the command
/// only.
Report measure_properties(bool quick, const std::function<void(double)>& progress);

/// The tables. `picture`: file name of the plot in the same folder; empty: none.
std::string to_markdown(const Report& report, const std::string& picture);
/// A CSV table with the columns scheme, omega_h, spectral_radius.
std::string decay_to_csv(const Report& report);

}  // namespace flexarm::bench
