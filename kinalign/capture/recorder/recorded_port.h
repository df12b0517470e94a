// SPDX-License-Identifier: Apache-2.0
// One device's port during recording. It reads the port and records each sender in its own channel.
// It counts losses by the senders' own numbers and answers if the protocol requires answers.
#pragma once

#include "kinalign/capture/net/followed_clock.h"
#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/recorder/findings_once.h"
#include "kinalign/capture/recorder/kinect_responder.h"
#include "kinalign/capture/recorder/recorded_source.h"
#include "kinalign/capture/recorder/slimevr_responder.h"
#include "kinalign/capture/recorder/stream_watch.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

/// The steps for each piece are: count, answer, record. Each piece of a sender that has a number is
/// recorded, even if it can't be decoded.
class RecordedPort {
 public:
  /// `secret`: random in each run and different for each port.
  static Result<RecordedPort> open(const DeviceOptions& device, const SipHashKey& secret);

  void add_fds(std::vector<int>& fds) const;
  /// Reads, answers and records a limited amount of the data that has arrived.
  void drain(HostAxis& axis, Recorder& recorder);
  /// Call about ten times a second. Sends the messages that the protocol requires at fixed times.
  void tick(HostTime now);
  /// Call once a second. Updates the senders' rates and looks for faults of the senders.
  void look(HostTime now);

  const DeviceOptions& device() const { return device_; }
  std::uint16_t port() const;
  PortCounts counts() const;
  /// Number of pieces since the port was opened, including refused ones.
  std::uint64_t received() const;
  /// Appends the status of each sender. The counts begin with the sender's first message.
  void add_streams(std::vector<StreamStatus>& all);
  /// Findings about senders since the previous call. Each fault is reported once per host.
  Findings take_findings() { return findings_.take(); }

 private:
  using Pieces = std::variant<UdpPieces, TcpPieces>;
  /// Everything about one sender that has a channel. It is made with the sender's first piece. It
  /// is replaced when the number is given to another sender.
  struct Source {
    RecordedSource recorded;
    RawChannel raw;
    StreamWatch watch;
    std::uint64_t serial = 0;  // serial number, see Senders
    NodeAddress address;       // address of the newest piece
    // channel of the clock exchanges; absent before the first ping
    std::optional<std::uint16_t> exchanges{};
    std::unique_ptr<FollowedClock> clock{};  // absent before the first ping
    // SlimeVR only: counts of this address before its newest handshake, datagrams by verdict, and
    // datagrams that contain a tracker's packet.
    SequenceCounts counts_before_handshake{};
    SlimeVerdicts verdicts{};
    std::uint64_t tracker_packets = 0;
    std::uint64_t pings_refused = 0;
  };

  RecordedPort(DeviceOptions device, const ProtocolRow& protocol, Pieces pieces,
               const SipHashKey& secret);
  static Result<Pieces> open_pieces(const DeviceOptions& device);
  void take(const Piece& piece, HostAxis& axis, Recorder& recorder);
  Source& source_of(const Piece& piece, Recorder& recorder);
  std::string topic(const char* content, std::uint64_t serial) const;
  /// Each answering function serves one protocol. Both send through this port.
  void answer_pings(Source& source, const Piece& piece, HostAxis& axis, Recorder& recorder);
  void answer_trackers(Source& source, const Piece& piece);
  void send_answers();
  template <class Visit>
  void for_each_source(Visit visit);
  /// `look_at` updates the counts. `find_faults` derives findings from them.
  void look_at(Source& source) const;
  void find_faults(const Source& source);

  bool has_datagrams() const { return std::holds_alternative<UdpPieces>(pieces_); }

  DeviceOptions device_;
  const ProtocolRow* protocol_;
  Pieces pieces_;
  std::vector<std::optional<Source>> sources_;  // indexed by the sender's number
  std::optional<Source> others_;                // shared by senders beyond Senders::most_serials
  NewestKinectFrames newest_frames_;
  FindingsOnce findings_;
  std::unique_ptr<SlimeResponder> slime_responder_;
  std::unique_ptr<KinectResponder> kinect_responder_;
};

}  // namespace kinalign
