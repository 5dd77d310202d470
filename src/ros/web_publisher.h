#pragma once
/// Shows the simulation on a web page.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "parameters.h"
#include "pictures/live_stream.h"
#include "web/live_server.h"

namespace flexarm::node {

/// Computes nothing while nobody looks at the page. Rates are by the wall clock.
class WebPublisher {
 public:
  /// @throws std::runtime_error if there can be no page
  WebPublisher(const Simulation& simulation, const Parameters& parameters, const std::string& node_name);
  WebPublisher(const WebPublisher&) = delete;
  WebPublisher& operator=(const WebPublisher&) = delete;

  const std::string& url() const { return server_.url(); }
  /// To be called after the simulation has got another scene, or other parameters. What the page has of the past stays
  /// if its picture is the same.
  void adopt_scene() { is_stale_ = true; }
  /// To be called after a reset: the page forgets the past.
  void begin_anew() { is_new_ = true; }
  /// Sends the present state if it is due.
  void publish();
  /// To be called regularly: serves those who come while no step is made, and makes another picture if it is needed,
  /// which may read the files of meshes.
  void tick();

 private:
  using Clock = std::chrono::steady_clock;

  void show(std::string picture);

  const Simulation& simulation_;
  std::string node_name_;
  Clock::duration period_;
  Clock::time_point next_;
  bool is_stale_ = true, is_new_ = true;  ///< the picture is not that of the scene; the past does not count
  web::LiveServer::Message picture_;      ///< as the page has it
  std::optional<pictures::LiveStream> stream_;
  web::LiveServer server_;
};

/// Serves the page if the parameters say so, and logs where it is. If there can be none it logs why, and returns null:
/// the simulation does without it.
std::unique_ptr<WebPublisher> serve_page(const Simulation& simulation, const Parameters& parameters,
                                         const std::string& node_name);

}  // namespace flexarm::node
