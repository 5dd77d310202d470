#include "analysis/nodal_dynamics.h"

#include "analysis/element_matrices.h"
#include "analysis/rotor_motion.h"
#include "joints/joint_stop.h"
#include "math/picked.h"
#include "math/so3.h"

namespace flexarm {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

void add(Triplets& entries, int first, const Matrix3& block) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (block(r, c) != 0) entries.emplace_back(first + r, first + c, block(r, c));
}

void add(Triplets& entries, const std::vector<int>& scalars, const Eigen::MatrixXd& block) {
  for (Eigen::Index r = 0; r < block.rows(); ++r)
    for (Eigen::Index c = 0; c < block.cols(); ++c) entries.emplace_back(scalars[r], scalars[c], block(r, c));
}

Eigen::SparseMatrix<double> summed(const Triplets& entries, Eigen::Index size) {
  Eigen::SparseMatrix<double> sum(size, size);
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

/// Adds the mass of beams, and the damping that is proportional to it.
void add_beams(const Model& model, const DegreesOfFreedom& dof, Triplets& mass, Triplets& damping) {
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        for (int k = 0; k < 3; ++k) {
          const int row = dof.first[element.nodes[i]] + k, column = dof.first[element.nodes[j]] + k;
          mass.emplace_back(row, column, element.mass(i, j));
          if (element.mass_damping != 0) damping.emplace_back(row, column, element.mass_damping * element.mass(i, j));
        }
  });
}

void add_coordinates(const Model& model, const DegreesOfFreedom& dof, const State& state, Triplets& mass,
                     Triplets& damping) {
  for (const Coordinate& coordinate : model.coordinates) {
    const int scalar = dof.scalar_of(coordinate);
    double slope = coordinate.damping;
    if (coordinate.limit)
      slope += stop_damping(*coordinate.limit, state.released[coordinate.joint].displacement[coordinate.component]);
    damping.emplace_back(scalar, scalar, slope);
  }
  for (const ActuatorTerms& terms : actuator_terms(model, state)) {
    const int scalar = dof.first[dof.variable_of_joint(terms.joint)] + terms.component;
    mass.emplace_back(scalar, scalar, terms.mass);
    damping.emplace_back(scalar, scalar, terms.damping);
  }
}

}  // namespace

NodalDynamics nodal_dynamics(const Model& model, const DegreesOfFreedom& dof, const State& state,
                             const CoordinateRates& rates) {
  const Eigen::Index size = rates.first.size();
  Triplets mass, damping, turning;
  NodalDynamics out;
  out.force = Eigen::VectorXd::Zero(size);
  add_beams(model, dof, mass, damping);
  add_coordinates(model, dof, state, mass, damping);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    const int first = dof.first[i], spin = first + 3;
    add(mass, first, inertia.mass * Matrix3::Identity());
    const Matrix3 rotary = inertia.rotary + inertia.beam_rotary;
    const Vector3 velocity = rates.first.segment<3>(spin), acceleration = rates.second.segment<3>(spin);
    const Matrix3 carried = so3::hat(velocity) * rotary, momentum = so3::hat(rotary * velocity);
    const Vector3 moment = rotary * acceleration + carried * velocity + inertia.rotary_damping * velocity;
    add(mass, spin, rotary);
    add(damping, spin, carried - momentum + inertia.rotary_damping);
    add(turning, spin, -so3::hat(moment));
    out.force.segment<3>(spin) = momentum * velocity;  // the sum below adds (carried - momentum) velocity
  }
  out.mass = summed(mass, size);
  out.damping = summed(damping, size);
  out.turning = summed(turning, size);
  out.force += out.mass * rates.second + out.damping * rates.first;
  return out;
}

std::vector<Stretch> damped_stretches(const Model& model, const DegreesOfFreedom& dof, const MechanismPose& pose) {
  std::vector<Stretch> stretches;
  const State state = state_at(pose);
  const auto add_stretch = [&](const std::vector<int>& nodes, Eigen::MatrixXd rows, const Eigen::MatrixXd& damping,
                               const ForceElement* element, const double* memory) {
    Stretch stretch{{}, std::move(rows), damping, element, memory};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (int k = 0; k < 6; ++k) stretch.scalars.push_back(dof.first[nodes[i]] + k);
      auto spins = stretch.rows.middleCols<3>(6 * static_cast<Eigen::Index>(i) + 3);
      spins = (spins * pose.nodes[nodes[i]].rotation).eval();
    }
    stretches.push_back(std::move(stretch));
  };
  for_each_element(model.beams, [&](const auto& element) {
    if (element.stiffness_damping == 0) return;
    const std::vector<Eigen::MatrixXd> strains = strain_variations(element, state);
    for (std::size_t k = 0; k < strains.size(); ++k)
      add_stretch({element.nodes.begin(), element.nodes.end()}, strains[k],
                  element.stiffness_damping * element.stiffness_points[k].weight *
                      damped_stiffness(element, static_cast<int>(k)),
                  nullptr, nullptr);
  });
  const std::vector<std::vector<int>> nodes = nodes_of(model.force_elements, state);
  const std::vector<const double*> memories = memories_of(model.force_elements, pose.force_memory);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const ForceElement& element = *model.force_elements[k];
    add_stretch(nodes[k], element.measures(state, memories[k], nodes[k].data()).rows, {}, &element, memories[k]);
  }
  return stretches;
}

StretchDamping stretch_damping(const Model& model, const DegreesOfFreedom& dof, const MotionMaps& maps,
                               const MechanismPose& pose, const CoordinateRates& rates, double spacing) {
  const std::vector<Stretch> stretches = damped_stretches(model, dof, pose);
  // Stack all rows, so that one function of time gives them all. Shorter rows end with zeros.
  const auto stacked = [&](const std::vector<Stretch>& parts) {
    Eigen::Index rows = 0, columns = 0;
    for (const Stretch& part : parts) rows += part.rows.rows(), columns = std::max(columns, part.rows.cols());
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::Index row = 0;
    for (const Stretch& part : parts) {
      all.block(row, 0, part.rows.rows(), part.rows.cols()) = part.rows;
      row += part.rows.rows();
    }
    return all;
  };
  // What touches at one of the poses and not at this one has other rows there. Then it counts as unchanged.
  const auto at_time = [&](double time) {
    std::vector<Stretch> parts = damped_stretches(model, dof, maps.moved(pose, rates, time));
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (parts[k].scalars != stretches[k].scalars || parts[k].rows.rows() != stretches[k].rows.rows())
        parts[k].rows = stretches[k].rows;
    return stacked(parts);
  };
  const MovingMatrix moving = along(at_time, stretches.empty() ? 0 : spacing);
  Triplets by_rates, by_places;
  const Eigen::VectorXd speeds = maps.at(pose) * rates.first;
  const State state = state_at(pose);
  StretchDamping out;
  out.of_elements = Eigen::VectorXd::Zero(maps.rows());
  Eigen::Index row = 0;
  for (const Stretch& part : stretches) {
    Eigen::MatrixXd slope = part.damping;
    if (part.element) {
      const DamperTensions dampers =
          part.element->dampers(state, part.memory, part.rows * picked_rows(speeds, part.scalars));
      add_to_rows(out.of_elements, part.scalars, part.rows.transpose() * dampers.tension);
      slope = dampers.slope;
    }
    const Eigen::MatrixXd forces = part.rows.transpose() * slope;
    const Eigen::MatrixXd damping = forces * part.rows;
    add(by_rates, part.scalars, damping);
    if (spacing > 0)
      add(by_places, part.scalars, forces * moving.first.block(row, 0, part.rows.rows(), part.rows.cols()));
    row += part.rows.rows();
  }
  out.by_rates = summed(by_rates, maps.rows());
  out.by_places = summed(by_places, maps.rows());
  return out;
}

}  // namespace flexarm
