#include "solver/tangent_backend.h"

#include <stdexcept>

#include "solver/sparse_tangent.h"
#include "solver/tree_tangent.h"

namespace flexarm {

const SparseTangent& TangentBackend::matrix() const {
  throw std::logic_error("the tangent is no matrix: its backend was not made for BackendChoice::Matrix");
}

std::unique_ptr<TangentBackend> make_tangent_backend(const Model& model, const DegreesOfFreedom& dof,
                                                     BackendChoice choice) {
  if (choice == BackendChoice::Fastest && TreeTangent::suits(model, dof))
    return std::make_unique<TreeTangent>(model, dof);
  return std::make_unique<SparseTangent>(model, dof);
}

}  // namespace flexarm
