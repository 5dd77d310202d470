#include "step_service.h"

#include <chrono>

#include "node.h"

namespace flexarm::node {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kMostSteps = 1000000;  ///< per call
/// How long steps are made before other callbacks are served.
constexpr std::chrono::milliseconds kTurn(10);

ros::ServiceServer advertise_step(ros::NodeHandle& node, ros::CallbackQueue& queue,
                                  const boost::function<bool(Step::Request&, Step::Response&)>& answer) {
  ros::AdvertiseServiceOptions options;
  options.init<Step>("step", answer);
  options.callback_queue = &queue;
  return node.advertiseService(options);
}

}  // namespace

StepService::StepService(ros::NodeHandle& private_node, Node& simulator)
    : simulator_(simulator),
      bell_([this] { go_on(); }),
      server_(advertise_step(
          private_node, queue_,
          [this](Step::Request& request, Step::Response& response) { return answer(request, response); })),
      spinner_(1, &queue_) {
  spinner_.start();
}

StepService::~StepService() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
    response_ = nullptr;
  }
  end_.notify_all();
  spinner_.stop();
  server_.shutdown();
}

bool StepService::answer(Step::Request& request, Step::Response& response) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (is_over_) return false;
  response_ = &response;
  asked_ = request.steps;
  made_ = 0;
  bell_.ring();
  end_.wait(lock, [this] { return response_ == nullptr; });
  return !is_over_;
}

void StepService::go_on() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!response_) return;
  if (made_ == 0) pauses_ = simulator_.pauses();
  const Clock::time_point turn = Clock::now() + kTurn;
  do {
    if (const std::string fault = refusal(); !fault.empty()) return end(fault);
    if (made_ == asked_) return end("");
    if (!simulator_.step()) return end(simulator_.run().failure);
    ++made_;
  } while (Clock::now() < turn);
  bell_.ring();  // other callbacks come first
}

std::string StepService::refusal() const {
  const std::string so_far = made_ > 0 ? ", after " + std::to_string(made_) + " steps" : "";
  if (!simulator_.run().paused) return "the simulation runs" + so_far + "; pause it first";
  if (simulator_.pauses() != pauses_) return "~pause was called" + so_far;
  if (asked_ > kMostSteps) return "more than " + std::to_string(kMostSteps) + " steps at once";
  return {};
}

void StepService::end(const std::string& fault) {
  if (fault.empty() || made_ > 0) simulator_.publish_state();
  response_->success = fault.empty();
  response_->message = fault;
  response_->time = simulator_.simulation().time();
  response_ = nullptr;
  end_.notify_all();
}

}  // namespace flexarm::node
