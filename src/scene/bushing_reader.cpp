#include "scene/bushing_reader.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "elements/bushing.h"
#include "flexarm/scene/bushing.h"
#include "model/model.h"
#include "scene/force_element_kinds.h"
#include "scene/readers.h"

namespace flexarm::scene {
namespace {

/// Asymmetry and negative eigenvalues that count as round-off, relative to the largest number.
constexpr double kRoundOff = 1e-9;

/// Reads a symmetric, positive semidefinite matrix: six numbers are its diagonal, 36 its rows.
Matrix6 read_matrix(const XmlElement& bushing, const char* attribute) {
  Matrix6 out = Matrix6::Zero();
  const std::optional<std::vector<double>> numbers = bushing.all_numbers(attribute, 36);
  if (!numbers) return out;
  if (numbers->size() != 6 && numbers->size() != 36) {
    bushing.attribute_error(attribute, fmt::format("{} must be 6 or 36 numbers", attribute));
    return out;
  }
  if (numbers->size() == 6)
    out.diagonal() = Eigen::Map<const Vector6>(numbers->data());
  else
    out = Eigen::Map<const Matrix6>(numbers->data()).transpose();
  const double largest = out.cwiseAbs().maxCoeff();
  if ((out - out.transpose()).cwiseAbs().maxCoeff() > kRoundOff * largest)
    bushing.attribute_error(attribute, fmt::format("the matrix of {} must be symmetric", attribute));
  else if (Eigen::SelfAdjointEigenSolver<Matrix6>(out, Eigen::EigenvaluesOnly).eigenvalues()[0] < -kRoundOff * largest)
    bushing.attribute_error(attribute, fmt::format("{} must not be negative in any direction", attribute));
  return 0.5 * (out + out.transpose());
}

}  // namespace

std::vector<double> BushingDescription::numbers() const {
  std::vector<double> numbers = {axes.w(), axes.x(), axes.y(), axes.z()};
  numbers.insert(numbers.end(), stiffness.data(), stiffness.data() + 36);
  numbers.insert(numbers.end(), damping.data(), damping.data() + 36);
  return numbers;
}

std::shared_ptr<ForceElementDescription> BushingDescription::with_links(const LinkChanges& change) const {
  auto out = std::make_shared<BushingDescription>(*this);
  const LinkChange first = out->change_links(change);
  out->axes = first.frame.orientation * axes;
  return out;
}

std::shared_ptr<const ForceElement> BushingDescription::place(const ForcePlacement& placement) const {
  NodePoint on_from = placement.places[0], on_to = placement.places[1];
  const auto turned = [&](const NodePoint& point) {
    return point.node < 0 ? Quaternion(Quaternion::Identity()) : (*placement.nodes)[point.node].orientation;
  };
  on_from.orientation = on_from.orientation * axes;
  const Quaternion in_world = turned(on_from) * on_from.orientation;
  on_to.orientation = turned(on_to).conjugate() * in_world;
  const Vector3 way = in_world.conjugate() * (placement.positions[1] - placement.positions[0]);
  return std::make_shared<Bushing>(name, on_from, on_to, Bushing::Law{stiffness, damping, way});
}

std::shared_ptr<const ForceElementDescription> read_bushing(const XmlElement& bushing) {
  bushing.expect_only({"name", "from", "from_at", "to", "to_at", "rpy", "stiffness", "damping"});
  auto out = std::make_shared<BushingDescription>();
  read_ends(bushing, *out);
  out->axes = read_pose(bushing).orientation;
  out->stiffness = read_matrix(bushing, "stiffness");
  if (bushing.has("damping")) out->damping = read_matrix(bushing, "damping");
  return out;
}

}  // namespace flexarm::scene
