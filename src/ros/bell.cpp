#include "bell.h"

#include <ros/init.h>
#include <boost/make_shared.hpp>

#include <cstdint>
#include <utility>

namespace flexarm::node {

class Bell::Callback : public ros::CallbackInterface {
 public:
  explicit Callback(Bell& bell) : bell_(bell) {}
  CallResult call() override {
    bell_.is_rung_.store(false);
    bell_.answer_();
    return Success;
  }

 private:
  Bell& bell_;
};

Bell::Bell(std::function<void()> answer) : answer_(std::move(answer)), thread_([this] { carry(); }) {}

Bell::~Bell() {
  is_over_.store(true);
  rung_.give();
  thread_.join();
  ros::getGlobalCallbackQueue()->removeByID(reinterpret_cast<std::uintptr_t>(this));
}

void Bell::ring() {
  if (!is_rung_.exchange(true)) rung_.give();
}

void Bell::carry() {
  for (rung_.take(); !is_over_.load(); rung_.take())
    ros::getGlobalCallbackQueue()->addCallback(boost::make_shared<Callback>(*this),
                                               reinterpret_cast<std::uintptr_t>(this));
}

}  // namespace flexarm::node
