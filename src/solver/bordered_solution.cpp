// BorderedElimination: forward elimination and back substitution.
#include <algorithm>

#include "math/simd.h"
#include "solver/bordered_elimination.h"

namespace flexarm {

void BorderedElimination::forward(int index, const Eigen::VectorXd& b, std::vector<double>& values) {
  const TreePart& part = order_.parts()[index];
  const Factors& f = factors_[index];
  if (part.front != index) return;
  if (f.joint >= 0) {
    const double *slave = values.data() + 6 * model_.joints[f.joint].slave, *left = memory(f.left);
    const int distance = 4 * lanes_for(f.target_count);
    for (int k = 0; k < 6; ++k)
      for (int t = 0; t < f.target_count; ++t) values[scalars_[f.targets + t]] += left[distance * k + t] * slave[k];
  }
  for (std::size_t i = 0; i < part.mimics.size(); ++i) {
    const DegreesOfFreedom::Mimic& mimic = dof_.mimics[part.mimics[i]];
    const int master = dof_.first[mimic.master_variable];
    if (is_placed_[master]) values[master] += memory(f.mimics)[2 * i] * values[dof_.first[mimic.slave_variable]];
  }
  for (int k = 0; k < f.held_count; ++k) {  // earlier eliminations do not contribute to these replaced rows
    const int scalar = scalars_[f.held + k];
    values[scalar] = b[dof_.equation[scalar]];
  }
  double* r = numbers(work_);
  const int lanes = f.stride / 4;
  for (int i = 0; i < f.size; ++i) r[i] = values[scalars_[f.rows + i]];
  const double* lower = memory(f.lower);
  simd::run([&] {
    for (int k = 0; k < f.pivots; ++k) {
      const Lanes pivot = broadcast(r[k]);
      for (int v = k / 4; v < lanes; ++v)
        store(load(r + 4 * v) - load(lower + f.stride * k + 4 * v) * pivot, r + 4 * v);
    }
  });
  std::copy_n(r, f.pivots, memory(f.forwarded));
  for (int i = f.pivots; i < f.size; ++i) values[scalars_[f.rows + i]] = r[i];
}

void BorderedElimination::backward(int index, std::vector<double>& values) const {
  const TreePart& part = order_.parts()[index];
  const Factors& f = factors_[index];
  if (part.front != index) return;
  double* x = numbers(work_);
  const int lanes = f.stride / 4;
  std::fill_n(x, f.stride, 0.0);
  for (int i = f.pivots; i < f.size; ++i) x[i] = values[scalars_[f.columns + i]];
  const double *upper = memory(f.upper), *reciprocals = memory(f.reciprocals), *forwarded = memory(f.forwarded);
  simd::run([&] {
    for (int k = f.pivots - 1; k >= 0; --k) {
      Lanes sum = {};
      for (int v = k / 4; v < lanes; ++v) sum += load(upper + f.stride * k + 4 * v) * load(x + 4 * v);
      x[k] = (forwarded[k] - ((sum[0] + sum[1]) + (sum[2] + sum[3]))) * reciprocals[k];
    }
  });
  for (int k = 0; k < f.pivots; ++k) values[scalars_[f.columns + k]] = x[k];
  for (int i = static_cast<int>(part.mimics.size()) - 1; i >= 0; --i) {
    const DegreesOfFreedom::Mimic& mimic = dof_.mimics[part.mimics[i]];
    values[dof_.first[mimic.slave_variable]] = memory(f.mimics)[2 * i + 1] * values[dof_.first[mimic.master_variable]];
  }
  if (f.joint < 0) return;
  double* slave = values.data() + 6 * model_.joints[f.joint].slave;
  const double* right = memory(f.right);
  const int distance = 4 * lanes_for(f.target_count);
  for (int k = 0; k < 6; ++k) {
    slave[k] = 0;
    for (int t = 0; t < f.target_count; ++t) slave[k] += right[distance * k + t] * values[scalars_[f.targets + t]];
  }
}

}  // namespace flexarm
