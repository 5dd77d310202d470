#pragma once
/// A browser for tests, which sends and receives bytes as the test says.

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace flexarm::test {

constexpr int kPatience = 10000;  ///< [ms]

class RawClient {
 public:
  /// @param room  for bytes that are not yet received; 0: as the system has it
  explicit RawClient(std::uint16_t port, int room = 0) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (room > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    is_connected_ = connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(RawClient&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), is_connected_(other.is_connected_), received_(other.received_) {}
  RawClient& operator=(RawClient&&) = delete;

  bool is_connected() const { return is_connected_; }
  void send(const std::string& bytes) { (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  void ask(const std::string& target, const std::string& headers, const std::string& method = "GET") {
    send(method + " " + target + " HTTP/1.1\r\n" + headers + "\r\n");
  }
  void ask_for_stream(const std::string& headers = "Host: localhost\r\n") {
    ask("/stream", headers +
                       "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
  }

  /// The next bytes, of which there are `size`, or fewer at the end.
  std::string take(std::size_t size) {
    while (received_.size() < size && receive(kPatience)) {
    }
    const std::string bytes = received_.substr(0, size);
    received_.erase(0, size);
    return bytes;
  }
  /// The next bytes up to `end`, or all of them.
  std::string take_until(const std::string& end) {
    std::size_t at;
    while ((at = received_.find(end)) == std::string::npos && receive(kPatience)) {
    }
    return take(at == std::string::npos ? received_.size() : at + end.size());
  }
  std::string take_all() {
    while (receive(kPatience)) {
    }
    return take(received_.size());
  }
  /// The next message of a WebSocket: its kind (1: text, 2: binary, 8: the end) and its bytes. The kind is 0 if the
  /// connection has ended.
  std::pair<int, std::string> take_message() {
    const std::string head = take(2);
    if (head.size() < 2) return {0, ""};
    const auto number = [](const std::string& bytes) {
      std::size_t value = 0;
      for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
      return value;
    };
    EXPECT_TRUE(head[0] & 0x80) << "the message is split";
    std::size_t size = static_cast<unsigned char>(head[1]);
    if (size >= 126) size = number(take(size == 126 ? 2 : 8));
    return {head[0] & 0xf, take(size)};
  }
  /// Whether nothing comes for a while.
  bool is_quiet() { return received_.empty() && !receive(200) && !has_ended_; }

 private:
  bool receive(int wait) {
    pollfd one{socket_, POLLIN, 0};
    if (poll(&one, 1, wait) != 1) return false;
    char bytes[65536];
    const ssize_t count = recv(socket_, bytes, sizeof bytes, 0);
    has_ended_ = count <= 0;
    if (!has_ended_) received_.append(bytes, static_cast<std::size_t>(count));
    return !has_ended_;
  }

  int socket_;
  bool is_connected_ = false, has_ended_ = false;
  std::string received_;
};

}  // namespace flexarm::test
