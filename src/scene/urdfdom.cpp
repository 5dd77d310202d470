#include "scene/urdfdom.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

namespace flexarm::scene {
namespace {

/// Takes console_bridge's messages as long as it lives.
class MessageCapture : public console_bridge::OutputHandler {
 public:
  MessageCapture() : previous_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  }
  ~MessageCapture() override {
    console_bridge::setLogLevel(level_);
    console_bridge::useOutputHandler(previous_);
  }
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors.push_back(text);
  }

  std::vector<std::string> errors;

 private:
  console_bridge::OutputHandler* previous_;
  console_bridge::LogLevel level_;
};

}  // namespace

std::vector<std::string> errors_of_urdfdom(std::string document) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  MessageCapture capture;
  // urdfdom logs some parts of the document as the format of printf. Nobody writes this control character.
  constexpr char kPercent = '\x1a';
  std::replace(document.begin(), document.end(), '%', kPercent);
  try {
    if (!urdf::parseURDF(document) && capture.errors.empty()) capture.errors.push_back("urdfdom cannot read it");
  } catch (const std::exception& error) {
    capture.errors.push_back(error.what());
  }
  for (std::string& error : capture.errors) std::replace(error.begin(), error.end(), kPercent, '%');
  return std::move(capture.errors);
}

std::string printed(const tinyxml2::XMLElement& element) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  element.Accept(&printer);
  return printer.CStr();
}

}  // namespace flexarm::scene
