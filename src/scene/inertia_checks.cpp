#include "scene/scene_checks.h"

#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

namespace flexarm::scene {
namespace {

/// Relative to the largest principal moment: smaller violations count as round-off.
constexpr double kRoundOff = 1e-9;
/// Relative to the largest principal moment: a negative moment up to this size results from numbers that were rounded
/// to few digits.
constexpr double kRoundedMoment = 1e-2;
/// Radius of gyration below which a body counts as a point mass: some exporters write such small numbers for zero. [m]
constexpr double kSmallestRadius = 1e-6;

double round_off(const Vector3& moments) {
  return kRoundOff * moments.cwiseAbs().maxCoeff();
}

/// Mass, first moment of mass and inertia of several bodies about the origin of a frame.
struct Composite {
  double mass = 0;
  Vector3 moment = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();

  void add(const RigidInertia& body, const Pose& pose) {
    const Vector3 center = pose * body.center_of_mass;
    const Matrix3 rotation = pose.orientation.toRotationMatrix();
    mass += body.mass;
    moment += body.mass * center;
    inertia += rotation * body.inertia * rotation.transpose() + body.mass * steiner(center);
  }
  /// Whether the inertia about the centre of mass is positive semidefinite, so that no kinetic energy is negative.
  bool can_be() const {
    const Matrix3 about_center = mass > 0 ? Matrix3(inertia - steiner(moment / mass) * mass) : inertia;
    const Vector3 moments = principal_moments(about_center);
    return moments[0] >= -round_off(moments) - mass * kSmallestRadius * kSmallestRadius;
  }
  static Matrix3 steiner(const Vector3& d) { return d.squaredNorm() * Matrix3::Identity() - d * d.transpose(); }
};

/// Groups of links that fixed joints connect to one rigid body, and the inertia of each group.
class RigidGroups {
 public:
  explicit RigidGroups(const SceneDescription& scene) {
    for (const LinkDescription& link : scene.links) links_.emplace(link.name, &link);
    for (const JointDescription& joint : scene.joints) below_[joint.parent].push_back(&joint);
    collect({scene.root_link, scene.root_link, Pose()});
  }

  const std::string& carrier(const std::string& link) const { return carriers_.at(link); }
  bool is_connected(const std::string& link) const { return carriers_.count(link) > 0; }
  const Composite& composite(const std::string& link) const { return composites_.at(carrier(link)); }

 private:
  struct Visit {
    std::string link, carrier;
    Pose pose;  // of the link in the frame of its carrier
  };

  /// Walks the tree from `root` to its leaves. Every link is visited once, also if the tree is faulty (such errors are
  /// recorded elsewhere).
  void collect(const Visit& root) {
    std::vector<Visit> stack = {root};
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const auto link = links_.find(visit.link);
      if (link == links_.end() || !carriers_.emplace(visit.link, visit.carrier).second) continue;
      const bool is_rigid = !link->second->beam;
      Composite& composite = composites_[visit.carrier];
      if (is_rigid && link->second->inertial) composite.add(*link->second->inertial, visit.pose);
      for (const JointDescription* joint : below_[visit.link]) {
        const bool is_fixed = joint->kind == JointKind::Fixed && is_rigid;
        stack.push_back(
            {joint->child, is_fixed ? visit.carrier : joint->child, is_fixed ? visit.pose * joint->origin : Pose()});
      }
    }
  }

  std::map<std::string, const LinkDescription*> links_;
  std::map<std::string, std::vector<const JointDescription*>> below_;
  std::map<std::string, std::string> carriers_;  // by link: the link nearest to the root in the same group
  std::map<std::string, Composite> composites_;  // by carrier
};

}  // namespace

Vector3 principal_moments(const Matrix3& inertia) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

namespace {

/// The nearest inertia without negative principal moments (in Frobenius' norm).
Matrix3 without_negative_moments(const Matrix3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(inertia);
  return principal.eigenvectors() * principal.eigenvalues().cwiseMax(0).asDiagonal() *
         principal.eigenvectors().transpose();
}

/// Judges a principal moment below 0.
void settle_negative_moment(const RigidGroups& groups, const SceneDescription& scene, LinkDescription& link,
                            const Vector3& moments, Findings& findings) {
  const std::string element = "<inertia> of link " + quoted(link.name), got = fmt::format("'{}'", moments[0]);
  const std::string expected = "principal moments of inertia must be >= 0";
  const int line = link.inertial->location.line;
  const double part = -moments[0] / moments.cwiseAbs().maxCoeff();
  if (groups.is_connected(link.name) &&
      (groups.carrier(link.name) == scene.root_link || groups.composite(link.name).can_be())) {
    findings.warning(line, element, expected + " (harmless here: this inertia never acts alone, or it is negligible)",
                     got);
  } else if (part <= kRoundedMoment) {
    link.inertial->inertia = without_negative_moments(link.inertial->inertia);
    findings.warning(line, element,
                     fmt::format("{}: {:.2g} of the largest one below 0 counts as rounded numbers, and 0 is taken "
                                 "instead",
                                 expected, part),
                     got);
  } else {
    findings.error(line, element, expected, got);
  }
}

}  // namespace

void settle_inertias(SceneDescription& scene, Findings& findings) {
  const RigidGroups groups(scene);
  for (LinkDescription& link : scene.links) {
    if (!link.inertial || link.beam) continue;
    const Vector3 moments = principal_moments(link.inertial->inertia);
    if (moments[0] < -round_off(moments))
      settle_negative_moment(groups, scene, link, moments, findings);
    else if (moments[2] > moments[0] + moments[1] + round_off(moments))
      findings.warning(link.inertial->location.line, "<inertia> of link " + quoted(link.name),
                       "no body has a principal moment of inertia larger than the sum of the others");
  }
}

}  // namespace flexarm::scene
