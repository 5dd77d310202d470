#include "bench/report.h"

#include <fmt/format.h>

namespace flexarm::bench {
namespace {

constexpr double kLowFrequency = 0.3, kHighFrequency = 100;  // omega h

Properties measure(const Variant& variant, bool quick) {
  Properties out;
  out.variant = variant;
  out.order = order_in_time(variant, quick);
  out.drift = invariant_drift(variant, quick);
  out.time_asymmetry = time_asymmetry(variant, quick);
  out.strain_change = strain_change(variant);
  out.static_path_dependence = static_path_dependence(variant);
  out.spin_dependence = spin_dependence(variant);
  out.at_low_frequency = dissipation(variant, kLowFrequency, quick);
  out.at_high_frequency = dissipation(variant, kHighFrequency, quick);
  return out;
}

std::vector<DissipationPoint> decay_of(const Variant& variant, bool quick) {
  std::vector<DissipationPoint> points;
  for (const double frequency : dissipation_frequencies(quick)) {
    const Measured<DissipationPoint> point = dissipation(variant, frequency, quick);
    if (!point.failure) points.push_back(point.value);
  }
  return points;
}

}  // namespace

Report measure_properties(bool quick, const std::function<void(double)>& progress) {
  // Approximate costs, in units of one row.
  constexpr double kCostShare = 0.1, kHardShare = 1.2;
  const std::vector<Variant> all = variants(), defaults = default_variants();
  const std::vector<HardScene> hard = hard_scenes();
  const double whole = static_cast<double>(all.size()) * (1 + kCostRuns * kCostShare) +
                       static_cast<double>(defaults.size() * hard.size()) * kHardShare;
  double done = 0;
  const auto advance = [&](double share) {
    done += share;
    progress(done / whole);
  };
  Report report;
  report.quick = quick;
  for (const Variant& variant : all) {
    report.rows.push_back(measure(variant, quick));
    advance(1);
  }
  const std::vector<Measured<Cost>> of_all = costs(all, quick, [&] { advance(kCostShare); });
  for (std::size_t i = 0; i < all.size(); ++i) report.rows[i].cost = of_all[i];
  for (const Variant& variant : defaults) {
    SchemeReport scheme{variant.name(), decay_of(variant, quick), {}};
    for (const HardScene& scene : hard) {
      scheme.robustness.push_back(robustness(variant, scene, quick));
      advance(kHardShare);
    }
    report.schemes.push_back(std::move(scheme));
  }
  return report;
}

std::string decay_to_csv(const Report& report) {
  std::string text = "scheme,omega_h,spectral_radius\n";
  for (const SchemeReport& scheme : report.schemes)
    for (const DissipationPoint& point : scheme.decay)
      text += fmt::format("{},{:.6g},{:.9f}\n", scheme.name, point.frequency, point.spectral_radius);
  return text;
}

}  // namespace flexarm::bench
