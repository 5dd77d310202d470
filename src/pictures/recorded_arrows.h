#pragma once
/// Forces and moments of runs of which only rows of results are left.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "pictures/recorded_columns.h"
#include "pictures/recorded_motion.h"
#include "pictures/recording.h"

namespace flexarm::pictures {

/// Makes the arrows of rows. Loads are those of the scene. All other arrows need columns: efforts joint/NAME/effort,
/// reactions sensor/NAME/* of the sensors that measure them, contacts contact/FIRST/SECOND/f*. The force of a contact
/// is shared out among the points where the two bodies touch.
class RecordedArrows {
 public:
  /// @param simulation  of the scene. Both arguments must outlive this object.
  RecordedArrows(const Simulation& simulation, const RecordedColumns& columns);

  /// A note for each kind of arrows for which the scene has a reason, but the rows have no columns.
  std::vector<std::string> notes() const;

  /// Overwrites `arrows` by those of the row that the motion shows.
  void find(std::size_t row, const RecordedMotion& motion, Arrows& arrows);

 private:
  struct Effort {
    std::size_t coordinate, link;  ///< the link that it carries
    std::size_t column;
  };
  struct Reaction {
    std::size_t sensor, link;
    RecordedColumns::Places<6> columns;
  };
  struct Contact {
    std::string first, second;
    std::optional<std::size_t> link;  ///< of the two; the place of forces if no touching point is found
    RecordedColumns::Places<3> columns;
  };

  void add_efforts(const Simulation& simulation);
  void add_reactions(const Simulation& simulation);
  void add_contacts(const Simulation& simulation);

  void find_efforts(std::size_t row, const Simulation& moved, const Simulation& shown, std::vector<ActingWrench>& out);
  void find_reactions(std::size_t row, const Simulation& shown, std::vector<ActingWrench>& out) const;
  void find_contacts(std::size_t row, const RecordedMotion& motion, std::vector<ActingWrench>& out);
  void share_out(const Contact& contact, const Vector3& force, const RecordedMotion& motion,
                 std::vector<ActingWrench>& out);

  const RecordedColumns& columns_;
  std::vector<Effort> efforts_;
  std::vector<Reaction> reactions_;
  std::vector<Contact> contacts_;
  std::vector<std::string> lacks_;       ///< what is not drawn
  std::vector<ActingWrench> unit_;       // scratch: of unit efforts
  std::vector<ActingContact> touching_;  // scratch
};

}  // namespace flexarm::pictures
