#pragma once
/// Which requests come from pages of this server itself.

#include <string>
#include <vector>

namespace flexarm::web {

/// The names by which browsers reach a server. A foreign page can make a browser send requests here under a name of its
/// own (DNS rebinding), but not under one of these.
class OwnNames {
 public:
  /// @param address  IP address at which the server listens
  explicit OwnNames(const std::string& address);

  /// Whether a request with this header `Host` is meant for this server. Its port does not matter: it may be forwarded.
  bool has(const std::string& host) const;

 private:
  bool has_address(const std::string& address) const;

  std::string address_;             ///< as the bytes of an IPv6 address
  std::vector<std::string> names_;  ///< in lower case
};

/// Whether a page of `origin` (header `Origin`) was loaded from where its request goes (header `Host`).
bool is_same_origin(const std::string& origin, const std::string& host);

/// Whether a text is an IPv4 or IPv6 address.
bool is_address(const std::string& text);
/// Whether it is one that only this machine reaches.
bool is_loopback(const std::string& text);

}  // namespace flexarm::web
