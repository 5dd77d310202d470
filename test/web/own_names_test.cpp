// Tests by which names a server may be reached.
#include "web/own_names.h"

#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace flexarm::web {
namespace {

std::string name_of_this_machine() {
  char name[256] = {};
  EXPECT_EQ(gethostname(name, sizeof name - 1), 0);
  return name;
}

TEST(OwnNames, AServerOfThisMachineIsReachedByNamesOfTheLoopback) {
  const OwnNames names("127.0.0.1");
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8090", "localhost:1", "LocalHost", "127.1.2.3:80", "[::1]:8090", "[::1]"})
    EXPECT_TRUE(names.has(host)) << host;
  for (const char* host : {"", ":8090", "evil.example", "evil.example:8090", "192.168.1.5", "localhost.evil.example",
                           "127.0.0.1.evil.example", "127.0.0.1:", "127.0.0.1:80:80", "127.0.0.1:8o", "[::1", "[::1]x",
                           "::1", "[", "localhost:80@evil.example"})
    EXPECT_FALSE(names.has(host)) << host;
  EXPECT_FALSE(names.has(name_of_this_machine() + ".evil.example"));
}

TEST(OwnNames, AServerOfAnAddressIsReachedByThatAndByTheMachinesName) {
  const OwnNames names("192.168.1.5");
  EXPECT_TRUE(names.has("192.168.1.5:8090"));
  EXPECT_TRUE(names.has("localhost:8090"));
  EXPECT_TRUE(names.has(name_of_this_machine() + ":8090"));
  EXPECT_TRUE(names.has(name_of_this_machine() + ".local"));
  EXPECT_FALSE(names.has("192.168.1.6"));
  EXPECT_FALSE(names.has(name_of_this_machine() + ".evil.example"));
}

TEST(OwnNames, AServerOfAllAddressesIsReachedByAnyAddressButNotByAnyName) {
  for (const char* any : {"0.0.0.0", "::"}) {
    const OwnNames names(any);
    EXPECT_TRUE(names.has("10.1.2.3:8090"));
    EXPECT_TRUE(names.has("[fe80::1]:8090"));
    EXPECT_FALSE(names.has("evil.example"));
  }
}

TEST(Origins, ArePagesOfTheSameHostAndPort) {
  EXPECT_TRUE(is_same_origin("http://localhost:8090", "localhost:8090"));
  EXPECT_TRUE(is_same_origin("https://LOCALHOST:8090", "localhost:8090"));
  for (const char* origin : {"null", "", "http://localhost:3000", "http://evil.example", "localhost:8090"})
    EXPECT_FALSE(is_same_origin(origin, "localhost:8090")) << origin;
}

TEST(Addresses, AreIpAddresses) {
  for (const char* address : {"127.0.0.1", "0.0.0.0", "::1", "::"}) EXPECT_TRUE(is_address(address)) << address;
  for (const char* address : {"", "localhost", "127.0.0", "[::1]", "127.0.0.1:80"})
    EXPECT_FALSE(is_address(address)) << address;
  for (const char* address : {"127.0.0.1", "127.9.9.9", "::1"}) EXPECT_TRUE(is_loopback(address)) << address;
  for (const char* address : {"0.0.0.0", "::", "10.0.0.1"}) EXPECT_FALSE(is_loopback(address)) << address;
}

}  // namespace
}  // namespace flexarm::web
