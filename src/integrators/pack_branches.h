#pragma once
/// Maxwell branches of a pack of elements over a step.

#include <algorithm>
#include <array>
#include <vector>

#include "elements/maxwell.h"
#include "math/pack.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// `Size`: number of strains, 6 in space and 3 in a plane. An element with fewer branches than others of the model has
/// further ones without stiffness.
template <int Size = 6>
class PackBranches {
 public:
  /// Takes over the branches of the element in a lane. `count`: Model::maxwell_branches; `points`: of the element.
  void set(int lane, const std::vector<MaxwellBranch>& branches, int first_point, int count, int points) {
    begin_.resize(static_cast<std::size_t>(count) * points, MaxwellBranches<Pack, Size>::Strain::Zero());
    end_ = begin_;
    coefficients_.resize(count);
    rules_[lane] = branches;
    rules_[lane].resize(count, {0, 1});
    first_[lane] = static_cast<std::size_t>(first_point) * count;
  }
  /// Starts a step. `project(lane, strain)`: the strain in the kernel's form.
  template <class Project>
  void begin(const State& state, double step, const Project& project) {
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      for (std::size_t b = 0; b < coefficients_.size() && step != step_; ++b)
        set_lane(coefficients_[b], lane, maxwell_coefficients(rules_[lane][b], step));
      for (std::size_t i = 0; i < begin_.size(); ++i)
        set_lane(begin_[i], lane, project(lane, state.branch_strains[first_[lane] + i]));
    }
    step_ = step;
  }
  /// Writes the strains at the end into the state. `expand(lane, strain)`: the inverse of `project`.
  template <class Expand>
  void accept(int lanes, State& state, const Expand& expand) const {
    for (int lane = 0; lane < lanes; ++lane)
      for (std::size_t i = 0; i < end_.size(); ++i)
        state.branch_strains[first_[lane] + i] = expand(lane, get_lane(end_[i], lane));
  }
  MaxwellBranches<Pack, Size> of_step() {
    return {static_cast<int>(coefficients_.size()), coefficients_.data(), begin_.data(), end_.data()};
  }

 private:
  std::array<std::vector<MaxwellBranch>, Pack::kLanes> rules_;
  std::array<std::size_t, Pack::kLanes> first_{};  // index into State::branch_strains
  double step_ = 0;                                // which the coefficients are for [s]
  std::vector<MaxwellCoefficients<Pack>> coefficients_;
  std::vector<typename MaxwellBranches<Pack, Size>::Strain> begin_, end_;
};

}  // namespace flexarm
