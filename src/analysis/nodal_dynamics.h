#pragma once
/// Inertia and damping of single nodes and coordinates, and their derivatives. (docs/notes/linearisation.md 2)

#include <Eigen/SparseCore>

#include "analysis/motion_maps.h"

namespace flexarm {

/// The entries belong to the rows of MotionMaps, whose rates x' and x'' are {v, W} of nodes with the material angular
/// velocity W. The rotary inertia of beams is lumped at nodes, as in the steps of the energy-momentum family.
struct NodalDynamics {
  Eigen::SparseMatrix<double> mass;     ///< derivative of the force by x''
  Eigen::SparseMatrix<double> damping;  ///< by x', gyroscopic terms included
  Eigen::SparseMatrix<double> turning;  ///< by x, for moments that turn with their node
  Eigen::VectorXd force;                ///< forces along world axes, moments in the node's own axes, efforts
};

NodalDynamics nodal_dynamics(const Model& model, const DegreesOfFreedom& dof, const State& state,
                             const CoordinateRates& rates);

/// A quantity that has a damper, and that is a linear function of a few rows of MotionMaps: the strains at a point of a
/// beam, or the measures of a force element.
struct Stretch {
  std::vector<int> scalars;     ///< rows of MotionMaps
  Eigen::MatrixXd rows;         ///< derivative of the quantity by those rows
  Eigen::MatrixXd damping;      ///< damping matrix, of strains only
  const ForceElement* element;  ///< the element with these measures; null: they are strains
  const double* memory;         ///< of the element, part of the pose's
};
/// All dampers between nodes, at a pose. Their order is the same at any pose.
std::vector<Stretch> damped_stretches(const Model& model, const DegreesOfFreedom& dof, const MechanismPose& pose);

/// Derivatives of the dampers' forces on the rows of MotionMaps: by x', and by x, since directions change along the
/// motion.
struct StretchDamping {
  Eigen::SparseMatrix<double> by_rates, by_places;
  Eigen::VectorXd of_elements;  ///< forces of force elements; those of strains are stresses of the beams
};
StretchDamping stretch_damping(const Model& model, const DegreesOfFreedom& dof, const MotionMaps& maps,
                               const MechanismPose& pose, const CoordinateRates& rates, double spacing);

}  // namespace flexarm
