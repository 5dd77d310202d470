#include "web/own_names.h"

#include <algorithm>
#include <cctype>

#include <arpa/inet.h>
#include <unistd.h>

namespace flexarm::web {
namespace {

constexpr std::size_t kBytes = 16;
const std::string kMapped = std::string(10, '\0') + "\xff\xff";  ///< IPv4 addresses begin like this among those of IPv6

/// The bytes of an IPv6 address, or those of an IPv4 address mapped to one; empty: the text is neither.
std::string bytes_of(const std::string& text) {
  char bytes[kBytes];
  if (inet_pton(AF_INET, text.c_str(), bytes) == 1) return kMapped + std::string(bytes, 4);
  if (inet_pton(AF_INET6, text.c_str(), bytes) == 1) return {bytes, kBytes};
  return {};
}

bool is_of_loopback(const std::string& bytes) {
  return bytes.compare(0, kMapped.size() + 1, kMapped + '\x7f') == 0 || bytes == bytes_of("::1");
}

bool is_any(const std::string& bytes) {
  return bytes == bytes_of("0.0.0.0") || bytes == bytes_of("::");
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The name or address within a header `Host`, without the port; empty: the header is wrong.
std::string name_in(const std::string& host) {
  const bool has_brackets = !host.empty() && host.front() == '[';
  const std::size_t end = has_brackets ? host.find(']') : host.find(':');
  const std::string rest = end == std::string::npos ? "" : host.substr(end + (has_brackets ? 1 : 0));
  const bool has_port =
      rest.size() > 1 && rest[0] == ':' && rest.find_first_not_of("0123456789", 1) == std::string::npos;
  if ((!rest.empty() && !has_port) || (has_brackets && end == std::string::npos)) return {};
  return has_brackets ? host.substr(1, end - 1) : host.substr(0, end);
}

}  // namespace

OwnNames::OwnNames(const std::string& address) : address_(bytes_of(address)), names_{"localhost"} {
  char name[256] = {};
  if (is_of_loopback(address_) || gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return;
  names_.push_back(lower_case(name));
  names_.push_back(names_.back() + ".local");
}

bool OwnNames::has(const std::string& host) const {
  const std::string name = lower_case(name_in(host));
  return has_address(bytes_of(name)) || std::find(names_.begin(), names_.end(), name) != names_.end();
}

bool OwnNames::has_address(const std::string& address) const {
  // A server at any address may have each of them. Foreign pages need a name.
  return !address.empty() && (is_of_loopback(address) || address == address_ || is_any(address_));
}

bool is_same_origin(const std::string& origin, const std::string& host) {
  const std::size_t colon = origin.find("://");
  return colon != std::string::npos && lower_case(origin.substr(colon + 3)) == lower_case(host);
}

bool is_address(const std::string& text) {
  return !bytes_of(text).empty();
}

bool is_loopback(const std::string& text) {
  return is_of_loopback(bytes_of(text));
}

}  // namespace flexarm::web
