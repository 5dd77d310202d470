#pragma once
/// Inertia and damping of all nodes and coordinates by themselves, and their derivatives. (docs/notes/linearisation.md
/// 2)

#include <Eigen/SparseCore>

#include "analysis/motion_maps.h"

namespace flexarm {

/// Of the rows of MotionMaps, whose rates x' and x'' are {v, W} of nodes with the material angular velocity W. The
/// rotary inertia of beams is lumped at nodes, as in the steps of the energy-momentum family.
struct NodalDynamics {
  Eigen::SparseMatrix<double> mass;     ///< derivative of the force by x''
  Eigen::SparseMatrix<double> damping;  ///< by x', gyroscopic terms included
  Eigen::SparseMatrix<double> turning;  ///< by x, of moments that turn with their node
  Eigen::VectorXd force;                ///< world forces, moments in the node's own axes, efforts
};

/// `contact_time`: of stops (Scheme::contact_time) [s].
NodalDynamics nodal_dynamics(const Model& model, const DegreesOfFreedom& dof, const State& state, double contact_time,
                             const CoordinateRates& rates);

/// What stretches as a few rows of MotionMaps move, and has a damper: strains of a beam's point, measures of a force
/// element.
struct Stretch {
  std::vector<int> scalars;     ///< rows of MotionMaps
  Eigen::MatrixXd rows;         ///< stretch by those
  Eigen::MatrixXd damping;      ///< of strains
  const ForceElement* element;  ///< whose measures these are; null: they are strains
};
/// Of all dampers between nodes, at a pose; in the same order at any pose.
std::vector<Stretch> damped_stretches(const Model& model, const DegreesOfFreedom& dof, const MechanismPose& pose);

/// Forces of dampers on the rows of MotionMaps by x' and, since directions change along the motion, by x.
struct StretchDamping {
  Eigen::SparseMatrix<double> by_rates, by_places;
  Eigen::VectorXd of_elements;  ///< what those of force elements are; those of strains are stresses of the beams
};
StretchDamping stretch_damping(const Model& model, const DegreesOfFreedom& dof, const MotionMaps& maps,
                               const MechanismPose& pose, const CoordinateRates& rates, double spacing);

}  // namespace flexarm
