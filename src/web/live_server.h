#pragma once
/// A server of one web page that shows what happens now.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace flexarm::web {

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< IP address of this machine at which it listens
  std::uint16_t port = 0;             ///< 0: any free one
  std::string page;                   ///< HTML
};

/// Answers `GET /` with the page, and sends messages to WebSockets at `/stream`: a *picture*, as text, then *instants*,
/// as bytes. Everything else is refused, and nothing that a browser sends changes anything. A thread of its own does
/// the work, and no function waits for it. A browser that reads slowly misses instants.
class LiveServer {
 public:
  using Message = std::shared_ptr<const std::string>;
  static constexpr std::size_t kMostViewers = 16;  ///< WebSockets at one time

  /// @throws std::runtime_error that says why it cannot listen there
  explicit LiveServer(const ServerOptions& options);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// `http://ADDRESS:PORT/`
  const std::string& url() const { return url_; }
  /// How many WebSockets are open.
  std::size_t viewers() const;
  /// Shows another picture from now on, also to those that connect later.
  void show(Message picture);
  /// Sends an instant of the picture. One that is equal to the last one is not sent again.
  void send(Message instant);

 private:
  class Inside;

  std::unique_ptr<Inside> inside_;
  std::string url_;
};

}  // namespace flexarm::web
