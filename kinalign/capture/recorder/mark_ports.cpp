// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/mark_ports.h"

#include "kinalign/capture/net/port_error.h"
#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/protocols/marks/vicon_trigger.h"
#include "kinalign/wire/little_endian_reader.h"

namespace kinalign {

namespace {

// Time during which a repeated mark is recognised: docs/formats/marks.md.
constexpr Duration call_repeats = std::chrono::minutes(10);
constexpr Duration trigger_repeats = std::chrono::seconds(5);

const char* port_name(MarkPort::Form form) {
  return form == MarkPort::Form::call ? "marks" : "trigger";
}

/// A datagram that is no mark at all may come from any program, so it is only a note.
Severity severity_of(MarkCallRefusal refusal) {
  using enum MarkCallRefusal;
  const bool anybodys = refusal == too_long || refusal == bad_json || refusal == wrong_schema;
  return anybodys ? Severity::note : Severity::warning;
}

Severity severity_of(ViconRefusal refusal) {
  using enum ViconRefusal;
  const bool anybodys = refusal == too_long || refusal == bad_xml || refusal == not_capture;
  return anybodys ? Severity::note : Severity::warning;
}

}  // namespace

Result<MarkPort> MarkPort::open(Form form, std::uint16_t port) {
  return MarkPort(form, KA_TRY(with_name(port_name(form), UdpPieces::open("", port))));
}

MarkPort::MarkPort(Form form, UdpPieces pieces)
    : form_(form),
      pieces_(std::move(pieces)),
      repeats_(form == Form::call ? call_repeats : trigger_repeats) {}

// The time of a mark is its arrival at this port.
void MarkPort::drain(HostAxis& axis, const TakeMark& take) {
  pieces_.drain(axis, [&](const Piece& piece) { take_piece(piece, take); });
}

std::string MarkPort::name() const { return port_name(form_); }

std::string MarkPort::sender_of(const Piece& piece) const {
  const Senders::Sender& sender = pieces_.senders().at(piece.sender);
  return endpoint_text(to_string(sender.host), sender.port);
}

/// Counts a refused datagram by its cause and reports it.
void MarkPort::refuse(const Piece& piece, Severity severity, const std::string& cause,
                      const char* expected) {
  ++counts_.refused[cause];
  findings_.add(to_string(pieces_.senders().at(piece.sender).host),
                {severity,
                 {"port of " + name(), 0, expected,
                  shown(piece.bytes) + " from " + sender_of(piece) + ": " + cause},
                 "the datagram is not a mark: it has no effect and is not recorded",
                 "docs/formats/marks.md shows the datagrams that this port accepts"});
}

/// Decodes one mark. If the call is refused and an answer is allowed, the cause is sent back.
bool MarkPort::decode(const Piece& piece, Mark& mark) {
  if (form_ == Form::call) {
    const MarkCallRefusal refusal = decode_mark_call(piece.bytes, mark);
    if (refusal == MarkCallRefusal::none) return true;
    refuse(piece, severity_of(refusal), kinalign::name_of(refusal), expected_of(refusal));
    const std::string text = answer_to_refused_call(mark, refusal, piece.bytes.size());
    if (!text.empty()) pieces_.send(piece.sender, octets(text));
    return false;
  }
  ViconTrigger trigger;
  const ViconRefusal refusal = decode_vicon_trigger(piece.bytes, trigger);
  if (refusal != ViconRefusal::none) {
    refuse(piece, severity_of(refusal), kinalign::name_of(refusal), expected_of(refusal));
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

// A repeated mark is answered again, because its sender may have missed the first answer. The mark
// is passed on only once.
void MarkPort::take_piece(const Piece& piece, const TakeMark& take) {
  RecordedMark received;
  if (!decode(piece, received.mark)) return;
  const bool again = repeats_.is_repeat(received.mark, piece.arrival);
  ++(again ? counts_.repeats : counts_.marks);
  if (form_ == Form::call) {
    const MarkAnswer answer = again ? MarkAnswer::repeat : MarkAnswer::fresh;
    const std::string text = answer_to_mark_call(received.mark, answer, piece.bytes.size());
    if (!text.empty()) pieces_.send(piece.sender, octets(text));
  }
  if (again) return;
  received.source = form_ == Form::call ? "call" : "trigger";
  received.sender = sender_of(piece);
  take(received, piece.arrival);
}

}  // namespace kinalign
