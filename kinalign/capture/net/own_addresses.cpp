// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/own_addresses.h"

#include "kinalign/capture/net/udp_socket.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <iterator>
#include <memory>

namespace kinalign {

namespace {

// A link-local address works only with the name of an interface of the other machine.
bool reaches_others(const ifaddrs& one) {
  if (one.ifa_addr == nullptr || (one.ifa_flags & IFF_UP) == 0) return false;
  if ((one.ifa_flags & IFF_LOOPBACK) != 0) return false;
  if (one.ifa_addr->sa_family == AF_INET) return true;
  if (one.ifa_addr->sa_family != AF_INET6) return false;
  return !IN6_IS_ADDR_LINKLOCAL(&reinterpret_cast<const sockaddr_in6*>(one.ifa_addr)->sin6_addr);
}

}  // namespace

std::vector<std::string> own_addresses() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> hold(all, &::freeifaddrs);
  std::vector<std::string> texts;
  for (const int family : {AF_INET, AF_INET6}) {
    for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
      const bool wanted = reaches_others(*one) && one->ifa_addr->sa_family == family;
      if (wanted) texts.push_back(address_text(*one->ifa_addr));
    }
  }
  return texts;
}

std::vector<std::string> reachable_at(const std::vector<std::string>& listen,
                                      const std::vector<std::string>& own) {
  if (listen.empty()) return own;
  std::vector<std::string> texts;
  for (const std::string& address : listen) {
    if (!is_any_address(address)) {
      texts.push_back(address);
      continue;
    }
    std::copy_if(own.begin(), own.end(), std::back_inserter(texts), [&](const std::string& one) {
      return is_ipv6_text(one) == is_ipv6_text(address);
    });
  }
  return texts;
}

}  // namespace kinalign
