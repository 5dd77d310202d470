#pragma once
/// A line over points and pulleys of any number of links that pulls and never pushes. (docs/notes/lines.md)

#include <memory>
#include <vector>

#include "elements/tendon_law.h"
#include "elements/tendon_piece.h"
#include "elements/tendon_slip.h"
#include "model/force_element.h"
#include "model/state.h"

namespace flexarm {

/// A guide of a tendon.
struct TendonGuide {
  GuidePlace place;
  bool grips = false;   ///< a pulley on which the line never slips
  double wrap = 0;      ///< of a pulley without grip and friction: the angle of contact at the start is the nearest
                        ///< possible one [rad]
  double friction = 0;  ///< coefficient of Coulomb friction

  /// Whether the tensions on both sides may differ.
  bool divides() const { return grips || friction > 0; }
};

/// A coordinate that pays the line out: the position of a node along a fixed direction.
struct TendonWinch {
  int node = -1;                         ///< -1: it stands still
  Vector3 direction = Vector3::UnitX();  ///< in the world
  double zero = 0;                       ///< position from which the rope paid out counts [m]
  double still = 0;                      ///< position if it stands still [m]
};

/// What a tendon is made of.
struct TendonPlan {
  std::vector<TendonGuide> guides;   ///< at least two; the first and the last are points, or pulleys that grip
  std::vector<TendonWinch> winches;  ///< they pay out the first part
  bool has_tension = false;          ///< whether the function of time is the tension; else it is the rest length
  TendonLaw law = {};
  double rest_length = 0;  ///< without a function of time; 0: as long as at the start [m]
};

/// A massless line. Guides that grip or have friction divide it into parts. A part has the same tension everywhere.
/// Rims of pulleys that divide the line carry material from one part to the other, and material slips over guides with
/// friction where the ratio of both tensions is exp(friction * angle of contact). The rest length that the function
/// gives is divided among the parts in the ratio of their lengths at the start. A pulley that does not divide the line
/// is left when the angle of contact becomes negative, and touched when the line comes to its rim. Which ones it
/// touches is settled between steps.
///
/// Memory: the function's value; per part the rest length that its rims count from, and that has slipped away, and the
/// rate at which it gains by slipping; then per guide whether the line touches it, and the angles at which it comes and
/// goes [rad].
class Tendon : public ForceElement {
 public:
  /// `functions`: index of the function of time, see TendonPlan::has_tension, or none. `poses`: of all nodes at the
  /// start.
  Tendon(std::string name, TendonPlan plan, std::vector<int> functions, const std::vector<NodePose>& poses);

  /// Its length at the start, without what is wound up on pulleys that grip [m]. Not finite if there is no such line.
  double length_at_start() const { return length_at_start_; }

  const char* kind() const override { return "tendon"; }
  std::string description() const override;

  /// The straight pieces, and a group for each part, if the line touches many nodes. Then evaluate() can also give one
  /// matrix.
  const ForcePieces& pieces() const override { return pieces_; }
  std::unique_ptr<ForceWorkspace> make_workspace() const override;
  void begin(const ForceStep& step) const override;
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override;
  double energy(const State& state, const double* memory) const override;
  ForceMeasures measures(const State& state, const double* memory, const int* nodes) const override;
  DamperTensions dampers(const State& state, const double* memory, const Eigen::VectorXd& rates) const override;
  int memory_size() const override { return 1 + 2 * parts_ + 3 * static_cast<int>(plan_.guides.size()); }
  bool uses_means() const override { return plan_.has_tension; }
  bool suits_backward_steps() const override;
  void start(const State& state, const double* functions, double* memory) const override;
  void carry(const ForceElement& before, const double* old_memory, const State& state, double* memory) const override;
  std::vector<ForceOutput> outputs() const override;
  void put_out(const ForceMotion& motion, std::vector<double>& values) const override;
  void put_line(const ForceMotion& motion, std::vector<Vector3>& points) const override;
  std::size_t most_line_points() const override;

 private:
  template <class Number>
  struct MemoryOf;  // a view of the memory
  using Memory = MemoryOf<const double>;
  using NewMemory = MemoryOf<double>;
  struct Span;  // a straight piece between two guides that the line touches
  struct MovedSpan;
  struct Workspace;
  struct PartForces;  // sums of the derivatives of the lengths of one part
  class Poses;        // of all nodes, from a state or a step

  struct Neighbours {
    int before, behind;
  };
  void find_part_nodes();
  void find_pieces();
  int group_rank() const;
  /// The guides that the line touches next to one.
  Neighbours neighbours(const Memory& memory, int guide) const;
  Span span(int first, int second, int part) const;
  /// Calls visit(span) for all spans along the line between the guides that are touched.
  template <class Visit>
  void for_each_span(const Memory& memory, const Visit& visit) const;
  /// The same for one part.
  template <class Visit>
  void for_each_span(const Memory& memory, int part, const Visit& visit) const;
  /// The rest length of a part, but for what its rims have wound up [m].
  double straight_rest(const Poses& poses, const Memory& memory, int part) const;
  TendonLengths lengths(const Poses& poses, const Memory& memory, int part) const;
  FunctionStep function_of(const ForceStep& step) const;
  double paid_out(const Poses& poses) const;
  double energy(const Poses& poses, const Memory& memory) const;
  /// Sets the angles to those at `poses` that are nearest to the present ones.
  void find_angles(const Poses& poses, const NewMemory& memory) const;
  void lay(const Poses& poses, double function, const NewMemory& memory) const;
  /// Lets the line leave pulleys and touch others. Returns whether it has done so.
  bool find_touched(const Poses& poses, const NewMemory& memory) const;
  bool has_rates(const ForceStep& step) const;
  void find_end(const ForceStep& step, const Memory& begin, const NewMemory& end, Workspace& workspace) const;
  void find_rates(const ForceStep& step, const Memory& begin, const Memory& end, Workspace& workspace) const;
  double contact_angle(const Poses& poses, const Memory& memory, int guide) const;
  bool find_steps(const ForceStep& step, const Memory& begin, const Memory& end, Workspace& workspace) const;
  void add_directions(const ForceStep& step, Workspace& workspace, ForceAction& action) const;
  void add_slope(const Span& span, double force, const Matrix12& slope, ForceAction& action) const;
  void add_forces(Workspace& workspace, ForceAction& action) const;
  void set_groups(const Workspace& workspace, PieceTangent& tangent) const;
  void add_products(Workspace& workspace, Eigen::Map<Eigen::MatrixXd>& tangent) const;
  /// The rate of a part's length minus its rest length, but for the function of time and slipping [m/s]. `velocities`:
  /// of all nodes.
  double stretch_rate(const Poses& poses, const Memory& memory, int part, const std::vector<Vector6>& velocities) const;
  /// Overwrites `out` by the gradients of the lengths of a part.
  void find_gradients(const Poses& poses, const Memory& memory, int part, PartForces& out) const;

  TendonPlan plan_;
  std::vector<int> guide_nodes_, winch_nodes_;  // indices into reach(); -1: world
  std::vector<std::vector<int>> part_nodes_;    // per part: the nodes on which its lengths depend, indices into reach()
  std::vector<int> winch_places_;               // indices into the nodes of the first part; -1: world
  struct GuidePlaces {
    int before, behind;
  };
  std::vector<GuidePlaces> guide_places_;  // indices into the nodes of the parts before and behind a guide; -1: world
  std::vector<int> part_ends_{0};          // guides at the ends of parts: the first, those that divide, the last
  int parts_ = 1;
  std::vector<double> shares_;  // per part, of the function's rest length
  double length_at_start_ = 0;
  ForcePieces pieces_;
  std::vector<int> first_piece_;  // per guide: index into pieces_.pairs of the piece to the next guide
  bool may_lift_ = false;         // whether there are pulleys that the line may leave
};

}  // namespace flexarm
