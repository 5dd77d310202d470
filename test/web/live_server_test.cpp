// Tests the server of live pages, by requests that are right, wrong, hostile or slow.
#include "web/live_server.h"

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "web/raw_client.h"

namespace flexarm::web {
namespace {

using test::RawClient;

const std::string kHost = "Host: localhost\r\n";

LiveServer::Message message(const std::string& text) {
  return std::make_shared<const std::string>(text);
}

void wait_until(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(test::kPatience);
  while (!condition() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ASSERT_TRUE(condition());
}

class LiveServerTest : public testing::Test {
 protected:
  std::uint16_t port() const {
    const std::string& url = server_.url();
    return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  /// The answer to one request, as a whole.
  std::string answer(const std::string& target, const std::string& headers, const std::string& method = "GET") {
    RawClient client(port());
    client.ask(target, headers, method);
    return client.take_all();
  }
  /// A WebSocket that is open.
  RawClient viewer(int room = 0) {
    RawClient client(port(), room);
    client.ask_for_stream();
    const std::string head = client.take_until("\r\n\r\n");
    EXPECT_NE(head.find("101 Switching Protocols"), std::string::npos) << head;
    EXPECT_NE(head.find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos) << head;  // RFC 6455, 1.3
    return client;
  }
  void expect_alive() { EXPECT_NE(answer("/", kHost).find("200 OK"), std::string::npos); }

  LiveServer server_{{"127.0.0.1", 0, "<p>the page</p>"}};
};

TEST_F(LiveServerTest, AnswersWithThePage) {
  EXPECT_EQ(server_.url(), "http://127.0.0.1:" + std::to_string(port()) + "/");
  for (const std::string& host : {kHost, "Host: 127.0.0.1:" + std::to_string(port()) + "\r\n"}) {
    const std::string text = answer("/", host);
    EXPECT_EQ(text.find("HTTP/1.1 200 OK\r\n"), 0) << text;
    EXPECT_NE(text.find("Content-Type: text/html; charset=utf-8\r\nContent-Length: 15\r\n"), std::string::npos) << text;
    EXPECT_EQ(text.substr(text.size() - 19), "\r\n\r\n<p>the page</p>");
  }
}

TEST_F(LiveServerTest, RefusesEverythingElse) {
  for (const char* target : {"/other", "/../etc/passwd", "/stream", "//", "/?x"})
    EXPECT_EQ(answer(target, kHost).find("HTTP/1.1 404 "), 0) << target;
  for (const char* method : {"POST", "PUT", "DELETE", "HEAD", "OPTIONS", "NONSENSE"})
    EXPECT_EQ(answer("/", kHost, method).find("HTTP/1.1 405 Method Not Allowed\r\nAllow: GET\r\n"), 0) << method;
  EXPECT_EQ(answer("/", kHost + "Content-Length: 5\r\n", "POST").find("HTTP/1.1 405 "), 0);
}

TEST_F(LiveServerTest, RefusesRequestsOfForeignPages) {
  for (const char* headers : {"Host: evil.example\r\n", "Host: localhost\r\nOrigin: http://evil.example\r\n",
                              "Host: localhost\r\nOrigin: null\r\n"}) {
    EXPECT_EQ(answer("/", headers).find("HTTP/1.1 403 "), 0) << headers;
    RawClient client(port());
    client.ask_for_stream(headers);
    EXPECT_EQ(client.take_all().find("HTTP/1.1 403 "), 0) << headers;
  }
  for (const char* headers : {"", "Host: localhost\r\nHost: evil.example\r\n"})
    EXPECT_EQ(answer("/", headers).find("HTTP/1.1 400 "), 0) << headers;
  EXPECT_EQ(server_.viewers(), 0);
}

TEST_F(LiveServerTest, SendsPicturesAndInstantsToAllViewers) {
  server_.show(message("{}"));
  RawClient first = viewer();
  EXPECT_EQ(first.take_message(), std::make_pair(1, std::string("{}")));
  server_.send(message("one"));
  EXPECT_EQ(first.take_message(), std::make_pair(2, std::string("one")));
  server_.send(message("one"));  // it is the same
  EXPECT_TRUE(first.is_quiet());
  RawClient second = viewer();  // it gets the state of now at once
  EXPECT_EQ(second.take_message(), std::make_pair(1, std::string("{}")));
  EXPECT_EQ(second.take_message(), std::make_pair(2, std::string("one")));
  const std::string large(70000, 'x'), larger(300, 'y');
  server_.show(message(large));
  server_.send(message(larger));
  for (RawClient* client : {&first, &second}) {
    EXPECT_EQ(client->take_message(), std::make_pair(1, large));
    EXPECT_EQ(client->take_message(), std::make_pair(2, larger));
  }
}

TEST_F(LiveServerTest, NoticesThatViewersLeave) {
  server_.show(message("{}"));
  {
    RawClient client = viewer();
    client.take_message();
    server_.send(message("one"));
    client.take_message();
  }
  wait_until([&] { return server_.viewers() == 0; });
  {
    RawClient client = viewer();
    EXPECT_EQ(client.take_message(), std::make_pair(1, std::string("{}")));
    EXPECT_TRUE(client.is_quiet()) << "an old instant was sent";
    client.send(std::string("\x88\x82\x01\x02\x03\x04\x02\xea", 8));  // the end, masked
    EXPECT_EQ(client.take_message().first, 8);
    EXPECT_EQ(client.take_message().first, 0);
  }
  wait_until([&] { return server_.viewers() == 0; });
}

TEST_F(LiveServerTest, SlowViewersMissInstants) {
  server_.show(message("{}"));
  RawClient slow = viewer(4096), quick = viewer();
  const std::size_t size = 100000;
  const int sent = 200;  // 20 MB, more than the system keeps for them
  EXPECT_EQ(quick.take_message().first, 1);
  for (int n = 0; n < sent; ++n) {
    server_.send(message(std::string(size, static_cast<char>(n))));
    EXPECT_EQ(quick.take_message(), std::make_pair(2, std::string(size, static_cast<char>(n))));
  }
  EXPECT_EQ(slow.take_message().first, 1);
  int received = 0;
  for (char last = 0; static_cast<unsigned char>(last) != sent - 1; ++received) {
    const std::string bytes = slow.take_message().second;
    ASSERT_EQ(bytes.size(), size);
    ASSERT_GE(static_cast<unsigned char>(bytes[0]), static_cast<unsigned char>(last)) << "instants changed places";
    last = bytes[0];
  }
  EXPECT_LT(received, sent / 2);
  EXPECT_TRUE(slow.is_quiet());
}

TEST_F(LiveServerTest, TellsOneViewerTooManySo) {
  server_.show(message("{}"));
  std::vector<RawClient> viewers;
  for (std::size_t n = 0; n < LiveServer::kMostViewers; ++n) viewers.push_back(viewer());
  RawClient client(port());
  client.ask_for_stream();
  EXPECT_NE(client.take_all().find("503 Service Unavailable"), std::string::npos);
  EXPECT_NE(answer("/", kHost).find("16 browsers look at this page already"), std::string::npos);
  viewers.pop_back();
  wait_until([&] { return server_.viewers() == LiveServer::kMostViewers - 1; });
  viewers.push_back(viewer());
}

TEST_F(LiveServerTest, GarbageDoesNoHarm) {
  std::string bytes;
  for (int n = 0; n < 4000; ++n) bytes += static_cast<char>(n * n % 251);
  for (const std::string& request : {std::string("nonsense\r\n\r\n"), bytes, std::string(1000, '\0'),
                                     std::string("\r\n\r\n"), "GET /" + std::string(100000, 'x') + " HTTP/1.1\r\n\r\n",
                                     "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100000, 'x') + "\r\n\r\n",
                                     std::string("GET / HTTP/9.9\r\n\r\n")}) {
    RawClient client(port());
    client.send(request);
    const std::string text = client.take_all();
    EXPECT_TRUE(text.empty() || text.find("HTTP/1.1 400 ") == 0) << text;
    RawClient cut(port());
    cut.send(request.substr(0, request.size() / 2));
  }
  expect_alive();
}

TEST_F(LiveServerTest, WhatViewersSendEndsTheirConnectionOnly) {
  server_.show(message("{}"));
  RawClient other = viewer();
  other.take_message();
  const std::string text("\x81\x82\x01\x02\x03\x04\x69\x6b", 8), ping("\x89\x80\x01\x02\x03\x04", 6);
  const std::string huge("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\x01\x02\x03\x04", 14);
  for (const std::string& bytes : {text, huge, std::string(1000, '\xff'), std::string(1000, '\0')}) {
    RawClient client = viewer();
    client.take_message();
    client.send(bytes);
    const int kind = client.take_message().first;
    EXPECT_TRUE(kind == 0 || kind == 8) << kind;
  }
  wait_until([&] { return server_.viewers() == 1; });
  other.send(ping);
  EXPECT_EQ(other.take_message().first, 10);  // pong
  server_.send(message("one"));
  EXPECT_EQ(other.take_message(), std::make_pair(2, std::string("one")));
}

TEST_F(LiveServerTest, ManyIdleConnectionsAreClosed) {
  std::vector<RawClient> idle;
  for (int n = 0; n < 100; ++n) idle.emplace_back(port());
  EXPECT_EQ(idle.back().take_all(), "");  // by the server, since there are too many
  idle.clear();
  wait_until([&] { return answer("/", kHost).find("200 OK") != std::string::npos; });
}

TEST_F(LiveServerTest, EndsWithOpenConnections) {
  auto other = std::make_unique<LiveServer>(ServerOptions{"127.0.0.1", 0, "page"});
  const std::string url = other->url();
  const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  RawClient idle(port), watching(port);
  watching.ask_for_stream();
  watching.take_until("\r\n\r\n");
  other->show(message("{}"));
  other.reset();
  EXPECT_FALSE(RawClient(port).is_connected());
  EXPECT_EQ(idle.take_all(), "");
}

TEST_F(LiveServerTest, SaysThatThePortIsInUse) {
  try {
    LiveServer({"127.0.0.1", port(), "page"});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "cannot listen at 127.0.0.1, port " + std::to_string(port()) + ": Address already in use");
  }
  EXPECT_THROW(LiveServer({"nonsense", 0, "page"}), std::runtime_error);
}

TEST(LiveServerAddress, MayBeOfIpv6) {
  try {
    EXPECT_EQ(LiveServer({"::1", 0, "page"}).url().find("http://[::1]:"), 0);
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << error.what();
  }
}

}  // namespace
}  // namespace flexarm::web
