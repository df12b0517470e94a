// SPDX-License-Identifier: Apache-2.0
// A device's port while it is recorded: its pieces, a channel for each sender, what the senders'
// own numbers miss, and the desk that answers them where the protocol wants answers.
#pragma once

#include "kinalign/capture/net/followed_clock.h"
#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/recorder/findings_once.h"
#include "kinalign/capture/recorder/held_back.h"
#include "kinalign/capture/recorder/kinect_desk.h"
#include "kinalign/capture/recorder/recorded_source.h"
#include "kinalign/capture/recorder/slimevr_desk.h"
#include "kinalign/capture/recorder/stream_watch.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

class RecordedPort {
 public:
  /// `secret`: random in each run and for each port.
  static Result<RecordedPort> open(const DeviceOptions& device, const SipHashKey& secret);

  void add_fds(std::vector<int>& fds) const;
  /// Takes, answers and records what has come. `until`: datagrams that came later are held back
  /// for release(), and count from then on. A connection's pieces have no arrival but when they are
  /// read: none is held.
  void drain(HostAxis& axis, Recorder& recorder, const std::optional<Moment>& until = std::nullopt);
  /// `until`: of what is held only that which is not later.
  void release(HostAxis& axis, Recorder& recorder,
               const std::optional<Moment>& until = std::nullopt);
  /// Ten times a second or so: what a desk says unasked.
  void tick(HostTime now);
  /// These for each of its senders, as RecordedSource has them; once a second faults are looked
  /// for.
  void look(HostTime now);
  void remember(std::uint64_t chunk, std::uint64_t first);
  void begin(std::uint64_t chunk);
  void tell(Recorder& recorder, std::uint16_t counts, HostTime now) const;

  const DeviceOptions& device() const { return device_; }
  std::uint16_t port() const;
  PortCounts counts() const;
  /// Pieces since it was opened, also refused ones.
  std::uint64_t heard() const;
  std::size_t held() const { return held_.size(); }
  void add_streams(std::vector<StreamStatus>& all) const;
  /// What the user should know of what is sent, since this was asked last: each fault of a host
  /// once.
  Findings take_findings() { return findings_.take(); }

 private:
  using Pieces = std::variant<UdpPieces, TcpPieces>;
  struct Source {
    RecordedSource recorded;
    RawChannel raw;
    StreamWatch watch;
    std::uint64_t life = 0;                    // of its sender
    NodeAddress address;                       // whose newest piece it was
    std::optional<std::uint16_t> exchanges{};  // channel
    std::unique_ptr<FollowedClock> clock{};    // since it pinged
    SequenceCounts greeted{};                  // of its address, up to the newest handshake there
    SlimeVerdicts verdicts{};                  // of a tracker's datagrams, and those of them …
    std::uint64_t spoken = 0;                  // … that spoke as trackers do
    std::uint64_t pings_refused = 0;
  };

  RecordedPort(DeviceOptions device, const ProtocolRow& protocol, Pieces pieces,
               const SipHashKey& secret);
  static Result<Pieces> open_pieces(const DeviceOptions& device);
  struct Held {
    Piece piece;
    Senders::Sender sender;  // its number may be another's meanwhile
    std::string bytes;
  };
  void take(const Piece& piece, const Senders::Sender& sender, HostAxis& axis, Recorder& recorder);
  const Senders::Sender& sender_of(const Piece& piece) const;
  Source& source_of(const Senders::Sender& sender, std::size_t number, Recorder& recorder);
  std::string topic(const char* content, std::uint64_t life) const;
  void answer_pings(Source& source, const Piece& piece, HostAxis& axis, Recorder& recorder);
  void answer_trackers(Source& source, const Piece& piece);
  void send_answers();
  template <class Port, class Visit>
  static void for_each_source(Port& port, Visit visit);
  void look_at(Source& source) const;
  void find_faults(const Source& source);

  bool has_datagrams() const { return std::holds_alternative<UdpPieces>(pieces_); }

  DeviceOptions device_;
  const ProtocolRow* protocol_;
  Pieces pieces_;
  std::vector<std::optional<Source>> sources_;  // by the sender's number
  std::optional<Source> others_;                // strangers after too many lives share it
  HeldBack<Held> held_;
  std::uint64_t held_bytes_ = 0;
  NewestKinectFrames newest_frames_;
  FindingsOnce findings_;
  std::unique_ptr<SlimeDesk> slimes_;
  std::unique_ptr<KinectDesk> kinects_;
};

}  // namespace kinalign
