// SPDX-License-Identifier: Apache-2.0
// UDP ports that receive marks, such as the start and stop of a take: docs/formats/marks.md.
#pragma once

#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/recorder/findings_once.h"
#include "kinalign/core/error.h"
#include "kinalign/protocols/marks/mark.h"
#include "kinalign/recording/counts.h"
#include "kinalign/recording/format.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

struct MarkPortCounts {
  // `marks` counts each mark once; `repeats` counts its repetitions.
  std::uint64_t marks = 0, repeats = 0;
  std::map<std::string, std::uint64_t> refused;  // by cause, such as "bad_json"
};

/// Each form has its own port, because a Vicon broadcast has no header that identifies it.
class MarkPort {
 public:
  enum class Form : std::uint8_t {
    call,    // kinalign's own format; each mark gets an answer
    trigger  // Vicon's broadcasts; they get no answer
  };
  static Result<MarkPort> open(Form form, std::uint16_t port);

  using TakeMark = std::function<void(const RecordedMark& mark, HostTime at)>;
  void add_fds(std::vector<int>& fds) const { pieces_.add_fds(fds); }
  /// Reads the marks that have arrived and passes each mark to `take` once.
  void drain(HostAxis& axis, const TakeMark& take);

  /// "marks" or "trigger".
  std::string name() const;
  std::uint16_t port() const { return pieces_.port(); }
  PortCounts port_counts() const;
  const MarkPortCounts& counts() const { return counts_; }
  /// Refused datagrams since the previous call. Each cause is reported once per host.
  Findings take_findings() { return findings_.take(); }

 private:
  MarkPort(Form form, UdpPieces pieces);
  /// Steps for each datagram: decode or refuse, answer, and pass on a new mark.
  bool decode(const Piece& piece, Mark& mark);
  void refuse(const Piece& piece, Severity severity, const std::string& cause,
              const char* expected);
  std::string sender_of(const Piece& piece) const;
  void take_piece(const Piece& piece, const TakeMark& take);

  Form form_;
  UdpPieces pieces_;
  MarkRepeats repeats_;
  MarkPortCounts counts_;
  FindingsOnce findings_;
};

}  // namespace kinalign
