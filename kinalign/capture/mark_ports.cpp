// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/mark_ports.h"

#include "kinalign/io/little_endian_reader.h"
#include "kinalign/io/mark_call.h"
#include "kinalign/io/vicon_trigger.h"

namespace kinalign {

namespace {

// How long a mark is known again: docs/formats/marks.md.
constexpr Duration call_repeats = std::chrono::minutes(10);
constexpr Duration trigger_repeats = std::chrono::seconds(5);

}  // namespace

Result<MarkPort> MarkPort::open(Form form, std::uint16_t port) {
  return MarkPort(form, KA_TRY(UdpPieces::open("", port)));
}

MarkPort::MarkPort(Form form, UdpPieces pieces)
    : form_(form),
      pieces_(std::move(pieces)),
      repeats_(form == Form::call ? call_repeats : trigger_repeats) {}

void MarkPort::drain(HostAxis& axis, const TakeMark& take) {
  pieces_.drain(axis, [&](const Piece& piece) { take_piece(piece, take); });
}

/// What is no mark is counted by its cause.
bool MarkPort::decode(const Piece& piece, Mark& mark) {
  if (form_ == Form::call) {
    const MarkCallRefusal refusal = decode_mark_call(piece.bytes, mark);
    if (refusal == MarkCallRefusal::none) return true;
    ++counts_.refused[kinalign::name_of(refusal)];
    return false;
  }
  ViconTrigger trigger;
  const ViconRefusal refusal = decode_vicon_trigger(piece.bytes, trigger);
  if (refusal != ViconRefusal::none) {
    ++counts_.refused[kinalign::name_of(refusal)];
    return false;
  }
  mark = mark_of(trigger);
  return true;
}

PortCounts MarkPort::port_counts() const {
  PortCounts counts = pieces_.counts();
  for (const auto& [cause, times] : counts_.refused) counts.refused += times;
  return counts;
}

void MarkPort::take_piece(const Piece& piece, const TakeMark& take) {
  RecordedMark heard;
  if (!decode(piece, heard.mark)) return;
  const bool again = repeats_.is_repeat(heard.mark, piece.arrival);
  ++(again ? counts_.repeats : counts_.marks);
  if (form_ == Form::call) {
    const MarkAnswer answer = again ? MarkAnswer::repeat : MarkAnswer::fresh;
    const std::string text = answer_to_mark_call(heard.mark, answer, piece.bytes.size());
    if (!text.empty()) pieces_.send(piece.sender, octets(text));
  }
  if (again) return;
  const Senders::Sender& sender = pieces_.senders().at(piece.sender);
  heard.source = form_ == Form::call ? "call" : "trigger";
  heard.sender = endpoint_text(to_string(sender.host), sender.port);
  take(heard, piece.arrival);
}

}  // namespace kinalign
