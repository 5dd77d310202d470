#pragma once
/// The oil on both sides of a piston. (docs/notes/oil.md)

#include <array>

#include "elements/line_ends.h"
#include "elements/oil_chamber.h"
#include "model/force_element.h"

namespace flexarm {

/// A coordinate that pumps oil from one chamber to the other: the position of a node along the world's x axis.
struct OilPump {
  int node = -1;     ///< -1: it stands still, or there is none
  double zero = 0;   ///< position from which the coordinate counts [m]
  double still = 0;  ///< position if it stands still [m]
};

/// What a hydraulic cylinder is made of. Chamber 0 is on the piston's side and grows with the length, chamber 1 is on
/// the rod's side and shrinks.
struct CylinderPlan {
  struct Chamber {
    OilChamber oil;
    double area = 0;            ///< change of the volume per length; negative on the rod's side [m^2]
    double volume = 0;          ///< at the length 0, outside of the stroke [m^3]
    double start_pressure = 0;  ///< [Pa]
  };
  NodePoint barrel, rod;  ///< their distance is the length; they are on different nodes, of which one at least moves
  OilPump pump;
  std::array<Chamber, 2> chambers;
  double start_length = 0;  ///< for the description [m]
};

/// Two chambers of oil that push the points of a cylinder apart. The pump lets in area * way of its coordinate, and so
/// does the function of time, which is the flow into chamber 0 [m^3/s]; what the rod's side loses then is less, in the
/// ratio of the areas. So both move the piston at the same speed, if the oil gives no way.
///
/// Memory: per chamber, its content less what the pump has let in since its coordinate was 0 [m^3].
class HydraulicCylinder : public ForceElement {
 public:
  /// `functions`: index of the flow, or none.
  HydraulicCylinder(std::string name, const CylinderPlan& plan, std::vector<int> functions);

  const char* kind() const override { return "cylinder"; }
  std::string description() const override;
  bool uses_means() const override { return !functions().empty(); }

  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  int memory_size() const override { return 2; }
  /// Not with valves.
  bool suits_backward_steps() const override;
  /// Both chambers get their pressures of the start.
  void start(const State& state, const double* functions, double* memory) const override;
  /// The oil stays.
  void carry(const ForceElement& before, const double* old_memory, const State& state, double* memory) const override;
  std::vector<ForceOutput> outputs() const override;
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;

 private:
  struct Contents;  // of both chambers
  struct Sums;      // what both chambers do together

  template <class Nodes>
  double pumped(const Nodes& nodes) const;
  Contents contents(const State& state, const double* memory) const;
  Sums sums(const ForceStep& step, double begin_length, double end_length) const;

  CylinderPlan plan_;
  std::array<int, 3> local_;  // indices into reach() of the nodes of rod, barrel and pump; -1: the world
};

}  // namespace flexarm
