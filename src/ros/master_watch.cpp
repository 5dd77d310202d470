#include "master_watch.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include <utility>

namespace flexarm::node {
namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::seconds kPeriod(1);

XmlRpcValue arguments(const std::vector<std::string>& texts) {
  XmlRpcValue out;
  out[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < texts.size(); ++i) out[static_cast<int>(i) + 1] = texts[i];
  return out;
}

/// Calls a method of the master. @returns false if the master does not answer, or answers with an error
bool ask(const std::string& method, const std::vector<std::string>& texts, XmlRpcValue& payload) {
  XmlRpcValue response;
  return ros::master::execute(method, arguments(texts), response, payload, /*wait_for_master=*/false);
}

const std::string& own_uri() {
  return ros::XMLRPCManager::instance()->getServerURI();
}

/// Tells this node of the publishers of a topic, in the way in which the master tells subscribers of new publishers.
void tell_of_publishers(const std::string& topic, const XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(own_uri(), host, port)) return;
  XmlRpcValue update = arguments({topic}), answer;
  update[2] = publishers;
  XmlRpc::XmlRpcClient(host.c_str(), static_cast<int>(port), "/").execute("publisherUpdate", update, answer);
}

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services)
    : services_(std::move(services)), thread_([this] { watch(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  end_.notify_all();
  thread_.join();
}

void MasterWatch::watch() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_.wait_for(lock, kPeriod, [this] { return is_over_; })) {
    lock.unlock();
    look();
    lock.lock();
  }
}

void MasterWatch::look() {
  if (!ros::master::check()) {
    if (!std::exchange(is_gone_, true))
      ROS_WARN_STREAM("the ROS master at " << ros::master::getURI()
                                           << " does not answer: the simulation goes on for all connected nodes");
    return;
  }
  is_gone_ = false;
  XmlRpcValue payload;
  if (ask("lookupNode", {ros::this_node::getName()}, payload) || ros::isShuttingDown()) return;
  register_anew();
  has_come_back_.store(true);
  ROS_WARN_STREAM("the ROS master at " << ros::master::getURI() << " did not know this node: registered again");
}

void MasterWatch::register_anew() const {
  XmlRpcValue payload;
  ros::V_string topics;
  ros::TopicManager::instance()->getAdvertisedTopics(topics);
  for (const std::string& topic : topics)
    if (const ros::PublicationPtr publication = ros::TopicManager::instance()->lookupPublication(topic))
      ask("registerPublisher", {topic, publication->getDataType(), own_uri()}, payload);
  topics.clear();
  ros::TopicManager::instance()->getSubscribedTopics(topics);
  for (const std::string& topic : topics)
    if (ask("registerSubscriber", {topic, "*", own_uri()}, payload)) tell_of_publishers(topic, payload);
  const std::string service_uri =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services_) ask("registerService", {service, service_uri, own_uri()}, payload);
}

}  // namespace flexarm::node
