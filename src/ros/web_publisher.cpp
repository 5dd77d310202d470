#include "web_publisher.h"

#include <ros/console.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "pictures/page.h"
#include "web/own_names.h"

namespace flexarm::node {
namespace {

constexpr double kLongestPeriod = 3600;  ///< [s]

}  // namespace

WebPublisher::WebPublisher(const Simulation& simulation, const Parameters& parameters, const std::string& node_name)
    : simulation_(simulation),
      node_name_(node_name),
      period_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(std::min(1 / parameters.web_rate, kLongestPeriod)))),
      server_({parameters.web_address, static_cast<std::uint16_t>(parameters.web_port), pictures::live_page()}) {}

void WebPublisher::publish() {
  if (is_stale_ || is_new_ || server_.viewers() == 0) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ += period_;
  if (next_ <= now) next_ = now + period_;
  pictures::LiveMessages messages = stream_->next(simulation_);
  if (!messages.picture.empty()) show(std::move(messages.picture));
  server_.send(std::make_shared<const std::string>(std::move(messages.instant)));
}

void WebPublisher::tick() {
  if (server_.viewers() == 0) return;
  if (is_stale_) stream_.emplace(simulation_, simulation_.scene().name + " (" + node_name_ + ")");
  if (is_stale_ || is_new_) {
    std::string picture = stream_->picture();
    if (is_new_ || picture != *picture_) show(std::move(picture));
    is_stale_ = is_new_ = false;
  }
  publish();
}

void WebPublisher::show(std::string picture) {
  picture_ = std::make_shared<const std::string>(std::move(picture));
  server_.show(picture_);
}

std::unique_ptr<WebPublisher> serve_page(const Simulation& simulation, const Parameters& parameters,
                                         const std::string& node_name) {
  if (!parameters.web) return nullptr;
  try {
    auto publisher = std::make_unique<WebPublisher>(simulation, parameters, node_name);
    ROS_INFO_STREAM("the page is at " << publisher->url());
    if (!web::is_loopback(parameters.web_address))
      ROS_WARN_STREAM("~web_address: everybody who reaches " << parameters.web_address << " can look at the page");
    return publisher;
  } catch (const std::runtime_error& error) {
    ROS_ERROR_STREAM("~web: there is no page: " << error.what());
    return nullptr;
  }
}

}  // namespace flexarm::node
