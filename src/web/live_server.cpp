#include "web/live_server.h"

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket.hpp>

#include "web/own_names.h"

namespace flexarm::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Error = beast::error_code;
using Message = LiveServer::Message;
using Request = http::request<http::empty_body>;

constexpr std::size_t kMostConnections = 64;   ///< requests at one time
constexpr std::size_t kLargestRequest = 8192;  ///< bytes of its header
constexpr std::size_t kLargestMessage = 1024;  ///< of a browser, bytes
constexpr int kUnsent = 1 << 18;               ///< of a slow browser, in the system's memory [bytes]
constexpr std::chrono::seconds kTimeToAsk{10}, kTimeToRead{60}, kTimeToShowLife{30};
constexpr std::chrono::milliseconds kWaitForDescriptors{200};

/// An answer to a request, after which the connection is closed.
Message answer(const std::string& status, const std::string& text, const std::string& kind = "text/plain") {
  return std::make_shared<const std::string>(
      fmt::format("HTTP/1.1 {}\r\nContent-Type: {}; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
                  "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n{}",
                  status, kind, text.size(), text));
}

class Viewer;

/// What connections share. Only the server's thread uses it, but for the number of viewers.
struct Desk {
  explicit Desk(const ServerOptions& options)
      : page(answer("200 OK", options.page, "text/html")), names(options.address) {}

  bool is_full() const { return viewers.size() >= LiveServer::kMostViewers; }
  void add(Viewer* viewer) {
    viewers.insert(viewer);
    viewer_count = viewers.size();
  }
  void remove(Viewer* viewer) {
    viewers.erase(viewer);
    viewer_count = viewers.size();
    if (viewers.empty()) instant = nullptr;  // it will be old when the next one comes
  }

  Message page, picture, instant;  ///< as answer; the last ones
  OwnNames names;
  std::set<Viewer*> viewers;
  std::atomic<std::size_t> viewer_count{0};
  std::size_t connections = 0;
};

/// A WebSocket. While a message is on its way, only the latest picture and the latest instant wait behind it.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(Desk& desk, beast::tcp_stream stream) : desk_(desk), socket_(std::move(stream)) {}

  void begin(const Request& request) {
    desk_.add(this);
    websocket::stream_base::timeout times;
    times.handshake_timeout = kTimeToAsk;
    times.idle_timeout = kTimeToShowLife;
    times.keep_alive_pings = true;
    beast::get_lowest_layer(socket_).expires_never();
    Error ignored;
    beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true), ignored);
    beast::get_lowest_layer(socket_).socket().set_option(tcp::socket::send_buffer_size(kUnsent), ignored);
    socket_.set_option(times);
    socket_.read_message_max(kLargestMessage);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](Error error) {
      if (error) return self->leave();
      self->is_open_ = true;
      self->show(self->desk_.picture);
      self->send(self->desk_.instant);
      self->listen();
    });
  }

  void show(const Message& picture) {
    picture_ = picture;
    instant_ = nullptr;  // of another picture
    write();
  }
  void send(const Message& instant) {
    instant_ = instant;
    write();
  }

 private:
  void write() {
    if (!is_open_ || sent_ || !(picture_ || instant_)) return;
    socket_.text(picture_ != nullptr);
    sent_ = std::exchange(picture_ ? picture_ : instant_, nullptr);
    socket_.async_write(asio::buffer(*sent_), [self = shared_from_this()](Error error, std::size_t) {
      if (error) return self->leave();
      self->sent_ = nullptr;
      self->write();
    });
  }

  /// Waits for the end. Viewers have nothing to say, so one that sends a message is dropped, too.
  void listen() {
    socket_.async_read(received_, [self = shared_from_this()](Error, std::size_t) { self->leave(); });
  }

  void leave() {
    is_open_ = false;
    desk_.remove(this);
    beast::get_lowest_layer(socket_).close();
  }

  Desk& desk_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer received_;
  bool is_open_ = false;
  Message picture_, instant_;  ///< not yet sent
  Message sent_;               ///< on its way
};

/// A request and its answer.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Desk& desk, tcp::socket socket) : desk_(desk), stream_(std::move(socket)) { ++desk_.connections; }
  ~Connection() { --desk_.connections; }

  void begin() {
    parser_.header_limit(kLargestRequest);
    stream_.expires_after(kTimeToAsk);
    http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](Error error, std::size_t) {
      if (!error)
        self->take(self->parser_.release());
      else if (error.category() == make_error_code(http::error::bad_target).category())
        self->write(answer("400 Bad Request", "this is not a request of HTTP, or too large\n"));
    });
  }

 private:
  void take(const Request& request) {
    const Message refusal = refusal_of(request);
    if (refusal) return write(refusal);
    if (request.target() == "/") return write(desk_.page);
    std::make_shared<Viewer>(desk_, std::move(stream_))->begin(request);
  }

  /// The answer to a request that is refused; null: it is not.
  Message refusal_of(const Request& request) const {
    const auto text = [](const auto& characters) { return std::string(characters.data(), characters.size()); };
    const std::string host = text(request[http::field::host]);
    if (request.count(http::field::host) != 1) return answer("400 Bad Request", "one header Host is expected\n");
    if (!desk_.names.has(host))
      return answer("403 Forbidden", "this page is shown only under an address of the machine that serves it\n");
    if (request.count(http::field::origin) > 0 && !is_same_origin(text(request[http::field::origin]), host))
      return answer("403 Forbidden", "other pages may not look at this one\n");
    if (request.method() != http::verb::get)  // its answer needs a header more
      return answer("405 Method Not Allowed\r\nAllow: GET", "there is only something to look at\n");
    const bool is_stream = request.target() == "/stream" && websocket::is_upgrade(request);
    if (!is_stream && request.target() != "/") return answer("404 Not Found", "there is no such page; try /\n");
    if (desk_.is_full())
      return answer("503 Service Unavailable",
                    fmt::format("{} browsers look at this page already, and it takes no more\n", desk_.viewers.size()));
    return nullptr;
  }

  void write(const Message& text) {
    stream_.expires_after(kTimeToRead);
    asio::async_write(stream_, asio::buffer(*text), [self = shared_from_this(), text](Error, std::size_t) {
      Error ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Desk& desk_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kLargestRequest};
  http::request_parser<http::empty_body> parser_;
};

}  // namespace

// ---------------------------------------------------------------- server

class LiveServer::Inside {
 public:
  explicit Inside(const ServerOptions& options) : desk_(options) {
    const tcp::endpoint place(asio::ip::make_address(options.address), options.port);
    acceptor_.open(place.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));  // connections of an ended server do not count
    acceptor_.bind(place);
    acceptor_.listen();
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Inside() {
    context_.stop();
    thread_.join();
  }

  tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }
  std::size_t viewers() const { return desk_.viewer_count; }

  void show(Message picture) {
    asio::post(context_, [this, picture = std::move(picture)] {
      desk_.picture = picture;
      desk_.instant = nullptr;
      for (Viewer* viewer : desk_.viewers) viewer->show(picture);
    });
  }
  void send(Message instant) {
    asio::post(context_, [this, instant = std::move(instant)] {
      if (desk_.viewers.empty() || (desk_.instant && *desk_.instant == *instant)) return;
      desk_.instant = instant;
      for (Viewer* viewer : desk_.viewers) viewer->send(instant);
    });
  }

 private:
  void accept() {
    acceptor_.async_accept([this](Error error, tcp::socket socket) {
      if (error) {  // there are too many open files, for example
        again_.expires_after(kWaitForDescriptors);
        return again_.async_wait([this](Error stopped) {
          if (!stopped) accept();
        });
      }
      if (desk_.connections < kMostConnections) std::make_shared<Connection>(desk_, std::move(socket))->begin();
      accept();
    });
  }

  Desk desk_;  // outlives the connections, which the context keeps
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer again_{context_};
  std::thread thread_;
};

LiveServer::LiveServer(const ServerOptions& options) {
  try {
    inside_ = std::make_unique<Inside>(options);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen at {}, port {}: {}", options.address, options.port, error.code().message()));
  }
  const tcp::endpoint place = inside_->endpoint();
  const std::string address = place.address().to_string();
  url_ = fmt::format(place.address().is_v6() ? "http://[{}]:{}/" : "http://{}:{}/", address, place.port());
}

LiveServer::~LiveServer() = default;

std::size_t LiveServer::viewers() const {
  return inside_->viewers();
}

void LiveServer::show(Message picture) {
  inside_->show(std::move(picture));
}

void LiveServer::send(Message instant) {
  inside_->send(std::move(instant));
}

}  // namespace flexarm::web
