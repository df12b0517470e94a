// SPDX-License-Identifier: Apache-2.0
// Asks the chronyd of this host, now and then, without ever waiting for it.
#pragma once

#include "kinalign/capture/ntp/chrony_tracking.h"

#include <cstdint>
#include <optional>

namespace kinalign {

class ChronyQuery {
 public:
  /// `port`: on 127.0.0.1; chronyd's cmdport. Where nobody listens there is no answer.
  explicit ChronyQuery(std::uint16_t port);
  ChronyQuery(ChronyQuery&& other) noexcept;
  ChronyQuery& operator=(ChronyQuery&& other) noexcept;
  ChronyQuery(const ChronyQuery&) = delete;
  ChronyQuery& operator=(const ChronyQuery&) = delete;
  ~ChronyQuery();

  /// The last answer, where it is no older than ten seconds; asks again every two.
  std::optional<ChronyTracking> latest(HostTime now);
  /// Waits for an answer that is under way, a tenth of a second at most.
  void wait() const;

 private:
  void receive(HostTime now);

  int fd_ = -1;
  std::uint32_t sequence_ = 0;
  std::optional<HostTime> asked_at_, answered_at_;
  ChronyTracking answer_;
};

}  // namespace kinalign
