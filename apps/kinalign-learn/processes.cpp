// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign-learn/processes.h"

#include <utility>

// LibTorch's Gloo can be used only if Gloo's headers are installed (Debian: libgloo-dev).
#if defined(USE_C10D_GLOO) && __has_include(<gloo/context.h>)
#define KINALIGN_HAS_GLOO 1
#include <arpa/inet.h>
#include <netdb.h>
#include <sys/socket.h>
#include <torch/csrc/distributed/c10d/PrefixStore.hpp>
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#include <unistd.h>

#include <array>
#include <chrono>
#include <vector>
#endif

namespace kinalign {

namespace {

Failure too_many(const ProcessPlace& place) {
  return Failure(Error{"", 0, "1 to " + std::to_string(most_processes) + " processes",
                       std::to_string(place.size)});
}

}  // namespace

#ifdef KINALIGN_HAS_GLOO

namespace {

// The time for all processes to connect. docs/training_processes.md states this limit and the next
// one.
constexpr std::chrono::minutes longest_start{5};
/// The longest wait for another process in one training step. If a process ends, its connections
/// close and the others notice at once. This limit is for a machine that vanishes from the network.
constexpr std::chrono::minutes longest_step{10};

using Gloo = c10d::ProcessGroupGloo;

/// This machine's address on the route to process 0; empty if there is no route. The machine's own
/// name is not used: it often resolves to 127.0.1.1, which other machines can't reach.
std::string own_address(const ProcessPlace& place) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(place.address.c_str(), std::to_string(place.port).c_str(), &hints, &found) != 0)
    return "";
  std::string out;
  // connect() on a datagram socket sends nothing: it only chooses the route and this machine's
  // address.
  const int way = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_storage own{};
  socklen_t length = sizeof own;
  std::array<char, NI_MAXHOST> text{};
  if (way >= 0 && ::connect(way, found->ai_addr, found->ai_addrlen) == 0 &&
      ::getsockname(way, reinterpret_cast<sockaddr*>(&own), &length) == 0 &&
      ::getnameinfo(reinterpret_cast<sockaddr*>(&own), length, text.data(), text.size(), nullptr, 0,
                    NI_NUMERICHOST) == 0) {
    out = text.data();
  }
  // Both resources are freed here, after success and after failure.
  if (way >= 0) ::close(way);
  ::freeaddrinfo(found);
  return out;
}

/// The network device for Gloo: the user's interface, else the one that leads to process 0, else
/// the one that Gloo chooses.
std::shared_ptr<::gloo::transport::Device> device_for(const ProcessPlace& place) {
  if (!place.interface.empty()) return Gloo::createDeviceForInterface(place.interface);
  const std::string own = own_address(place);
  return own.empty() ? Gloo::createDefaultDevice() : Gloo::createDeviceForHostname(own);
}

}  // namespace

/// The connections between the processes. The function in `share_` has a copy of the pointer to the
/// group, so the connections last as long as the share is used.
struct Processes::Group {
  ProcessPlace place;
  c10::intrusive_ptr<c10d::Store> store;
  c10::intrusive_ptr<Gloo> gloo;

  /// Sums the values over all processes. Returns false if another process has ended, for which
  /// LibTorch throws an exception.
  bool sum(torch::Tensor& values) const {
    try {
      std::vector<at::Tensor> all{values};
      // allreduce() replaces `values` by the sum.
      gloo->allreduce(all)->wait();
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
};

Result<Processes> Processes::join(const ProcessPlace& place) {
  Processes out;
  if (place.size == 1) return out;
  if (place.size < 1 || place.size > most_processes) return too_many(place);
  try {
    c10d::TCPStoreOptions start;
    start.port = place.port;
    // Process 0 serves the store, through which all processes find each other.
    start.isServer = place.rank == 0;
    start.numWorkers = static_cast<std::size_t>(place.size);
    start.timeout = longest_start;
    auto group = std::make_shared<Group>();
    group->place = place;
    group->store = c10::make_intrusive<c10d::TCPStore>(place.address, start);
    auto options = Gloo::Options::create(longest_step);
    options->devices.push_back(device_for(place));
    group->gloo = c10::make_intrusive<Gloo>(
        c10::make_intrusive<c10d::PrefixStore>("gloo", group->store), static_cast<int>(place.rank),
        static_cast<int>(place.size), options);
    out.share_ = {place.rank, place.size, [group](torch::Tensor& all) { return group->sum(all); }};
    out.group_ = std::move(group);
    return out;
  } catch (const std::exception& fault) {
    return Failure(Error{"", 0,
                         "all " + std::to_string(place.size) +
                             " processes to connect within five minutes to " +
                             shown(place.address) + ":" + std::to_string(place.port),
                         shown(fault.what())});
  }
}

Result<void> Processes::agree(const std::string& text) {
  if (!group_) return {};
  try {
    // Process 0 stores its text. The get() of the other processes waits until the text is there.
    const std::vector<std::uint8_t> own(text.begin(), text.end());
    if (share_.is_first()) group_->store->set("job", own);
    if (group_->store->get("job") == own) return {};
  } catch (const std::exception&) {
    return Failure(Error{"", 0, "all processes of the training to start",
                         "a process that ended before the start", ErrorKind::lost_process});
  }
  return Failure(
      Error{"", 0, "the same job, data and checkpoint in every process",
            "others in process " + std::to_string(group_->place.rank) + " than in process 0"});
}

void Processes::leave() {
  if (!group_) return;
  try {
    group_->gloo->barrier()->wait();
  } catch (const std::exception&) {  // the training is done, so a lost process does no harm
  }
}

// Without Gloo one process can train; several processes are refused with the reason.
#else

struct Processes::Group {};

Result<Processes> Processes::join(const ProcessPlace& place) {
  if (place.size == 1) return Processes();
  return Failure(
      Error{"", 0,
            "a kinalign-learn that was built with Gloo (Debian: libgloo-dev) to train in "
            "several processes",
            "a kinalign-learn without Gloo"});
}

Result<void> Processes::agree(const std::string&) { return {}; }
void Processes::leave() {}

#endif

}  // namespace kinalign
