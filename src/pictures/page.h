#pragma once
/// Writes HTML files that play runs.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/simulation/result_writer.h"
#include "pictures/recording.h"

namespace flexarm::pictures {

/// The time that a page shows first [s]; empty: that of the largest strain.
using FirstTime = std::optional<double>;

/// The text of a page that plays these runs side by side. It contains all that it needs, three.js included.
/// @throws std::runtime_error if the player's files or three.js are not installed
std::string page_of(const std::vector<EncodedRun>& runs, FirstTime first_time = {});

/// The text of a page that shows what a WebSocket at `/stream` of the same server sends (LiveStream).
/// @throws std::runtime_error as page_of()
std::string live_page();

/// Writes a page; if that fails, an existing file stays as it was.
/// @throws std::runtime_error naming the file and the reason
void write_page(const std::string& path, const std::vector<EncodedRun>& runs, FirstTime first_time = {});

/// Writes a run as a page.
class PageWriter : public ResultWriter {
 public:
  /// @param simulation  must outlive the writer, and be in the state of the last row when it is closed
  /// @throws std::runtime_error if the page could not be written
  PageWriter(const std::string& path, const Simulation& simulation, const RecordingOptions& options,
             FirstTime first_time = {});

  void write_row(const Simulation& simulation) override;
  void close() override;

 private:
  std::string path_;
  const Simulation& simulation_;
  Recording recording_;
  FirstTime first_time_;
};

}  // namespace flexarm::pictures
