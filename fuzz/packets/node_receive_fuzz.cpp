// SPDX-License-Identifier: Apache-2.0
// Datagrams on a node's port, compared with a plain count of those that must be accepted: an answer
// that is whole, for this node, this start and one of its last 64 frames, the first answer to that
// frame or a later one. All others are counted and change nothing.
//
// The input: a byte (1 a key, 2 clockless), then a byte for each step: 0 to 63 ticks and polls, 64
// to 127 so many bytes arrive, 128 to 191 they arrive repaired (see node_datagrams.h), and from 192
// on they are an answer's fields after the head of an answer to the frame so many before the last.
#include "firmware/node/clockless_node.h"
#include "firmware/node/count_names.h"
#include "firmware/node/node.h"
#include "fuzz/packets/node_datagrams.h"

#include "kinalign/wire/clockless.h"
#include "kinalign/wire/node_reply.h"

#include <deque>

using namespace kinalign;

namespace {

using Bytes = std::vector<std::uint8_t>;

void require(bool holds) {
  if (!holds) std::abort();
}

class FuzzBoard : public Board {
 public:
  std::uint64_t counter_us() override { return ++now_us; }
  bool read_imu(NodeSample& sample) override {
    sample.has_acceleration = true;
    return true;
  }
  bool send(std::span<const std::uint8_t> datagram) override {
    sent.emplace_back(datagram.begin(), datagram.end());
    return true;
  }
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override {
    if (arriving.empty()) return false;
    size = std::min(room.size(), arriving.front().size());
    std::copy_n(arriving.front().begin(), size, room.begin());
    arriving.pop_front();
    return true;
  }
  bool read_battery(std::uint16_t&) override { return false; }
  void show(const Lights&) override {}
  void lock() override {}
  void unlock() override {}

  std::uint64_t now_us = 0;
  std::deque<Bytes> arriving;
  std::vector<Bytes> sent;
};

/// Counts the answers that a node must accept, by the rules of docs/formats/imu_node.md.
template <class Answer>
class Account {
 public:
  explicit Account(const MacKey* key) : key_(key) {}

  void arrives(const Bytes& bytes, std::uint32_t frames) {
    ++arrived;
    Envelope envelope;
    Answer answer;
    if (open_envelope(bytes, envelope) != NodeRefusal::none) return;
    if (decode(envelope, key_, answer) != NodeRefusal::none) return;
    const DatagramOrigin& origin = answer.origin;
    if (origin.node_id != 7 || origin.boot_id != 9 || origin.sequence >= frames) return;
    if (frames - origin.sequence > 64 || origin.sequence < first_open_) return;
    first_open_ = origin.sequence + 1;
    ++accepted;
    has_newest = true;
    newest = answer;
  }

  std::uint64_t arrived = 0, accepted = 0;
  bool has_newest = false;
  Answer newest;

 private:
  const MacKey* key_;
  std::uint32_t first_open_ = 0;
};

template <class Datagram>
Datagram opened(const Bytes& bytes, const MacKey* key) {
  Envelope envelope;
  Datagram datagram;
  require(open_envelope(bytes, envelope) == NodeRefusal::none);
  require(decode(envelope, key, datagram) == NodeRefusal::none);
  return datagram;
}

void check_counts(const AnswerCounts& counts, std::uint64_t arrived, std::uint64_t accepted) {
  std::uint64_t sum = 0;
  each_answer_count(counts, [&](const char*, std::uint64_t number) { sum += number; });
  require(sum == arrived && counts.accepted == accepted);
}

/// A node with a counter, and the frames that it sends after each poll.
struct Frames {
  using Answer = NodeReply;
  static constexpr DatagramType type = DatagramType::reply;
  Frames(Board& board, const NodeSettings& settings) : node(board, settings) {}

  void check(const FuzzBoard& board, Account<Answer>& account, const MacKey* key) {
    for (; checked < board.sent.size(); ++checked) {
      const auto frame = opened<NodeFrame>(board.sent[checked], key);
      require(frame.origin == DatagramOrigin{7, 9, static_cast<std::uint32_t>(checked)});
      require(frame.has_echo == account.has_newest);
      if (frame.has_echo) {
        require(frame.echo.reply_sequence == account.newest.reply_sequence);
        require(frame.echo.nonce == account.newest.nonce && frame.echo.n_rx_us < frame.n_tx_us);
      }
      account.has_newest = false;
    }
    check_counts(node.counts().replies, account.arrived, account.accepted);
  }
  std::uint32_t begun(const FuzzBoard& board) const {
    return static_cast<std::uint32_t>(board.sent.size());
  }

  Node node;
  std::size_t checked = 0;
};

/// A node without a counter.
struct Requests {
  using Answer = ClocklessAnswer;
  static constexpr DatagramType type = DatagramType::answer;
  Requests(Board& board, const NodeSettings& settings) : node(board, settings) {}

  void check(const FuzzBoard& board, Account<Answer>& account, const MacKey* key) {
    require(node.counts().confirms == account.accepted);
    require(board.sent.size() == node.counts().requests + account.accepted);
    check_counts(node.counts().answers, account.arrived, account.accepted);
    if (account.has_newest && !board.sent.empty() && board.sent.back()[5] == 5) {
      const auto confirm = opened<ClocklessConfirm>(board.sent.back(), key);
      require(confirm == ClocklessConfirm{account.newest.origin, account.newest.times});
    }
  }
  std::uint32_t begun(const FuzzBoard&) const {
    return static_cast<std::uint32_t>(node.counts().requests);
  }

  ClocklessNode node;
};

template <class Kind>
void live(std::span<const std::uint8_t> input, bool keyed) {
  const MacKey* key = keyed ? &fuzz_key : nullptr;
  FuzzBoard board;
  Kind kind(board, {.node_id = 7, .boot_id = 9, .has_key = keyed, .key = fuzz_key});
  Account<typename Kind::Answer> account(key);
  kind.node.set_link(true);
  while (!input.empty()) {
    const std::uint8_t step = input[0];
    input = input.subspan(1);
    if (step < 64) {
      board.now_us += step * 1000U;
      kind.node.tick(step % 3);
    } else {
      const std::size_t size = std::min<std::size_t>(step % 64, input.size());
      Bytes bytes(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(size));
      input = input.subspan(size);
      if (step >= 192) {
        Bytes head(node_head_size);
        const DatagramOrigin origin{7, 9, kind.begun(board) - step % 64};
        begin_datagram(head, head.size(), {Kind::type, origin, 0, 0, 0}, key);
        bytes.insert(bytes.begin(), head.begin(), head.end());
        bytes.resize(node_datagram_size(Kind::type == DatagramType::reply ? 16 : 20, keyed));
      }
      if (step >= 128) mend(bytes, Kind::type, key);
      account.arrives(bytes, kind.begun(board));
      board.arriving.push_back(std::move(bytes));
    }
    kind.node.poll();
    kind.check(board, account, key);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || size > 4096) return 0;
  const auto input = std::span(data, size).subspan(1);
  const bool keyed = (data[0] & 1) != 0;
  if ((data[0] & 2) == 0) {
    live<Frames>(input, keyed);
  } else {
    live<Requests>(input, keyed);
  }
  return 0;
}
