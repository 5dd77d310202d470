#include "solver/tangent_backend.h"

#include "solver/sparse_tangent.h"
#include "solver/tree_tangent.h"

namespace flexarm {

std::unique_ptr<TangentBackend> make_tangent_backend(const Model& model, const DegreesOfFreedom& dof,
                                                     BackendChoice choice) {
  if (choice == BackendChoice::Fastest && TreeTangent::suits(model, dof))
    return std::make_unique<TreeTangent>(model, dof);
  return std::make_unique<SparseTangent>(model, dof);
}

}  // namespace flexarm
