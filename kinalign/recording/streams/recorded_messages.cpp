// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recorded_messages.h"

#include "kinalign/recording/survey.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_names = 32;  // of streams and nodes in messages

void remember(std::set<std::string>& names, const std::string& name) {
  if (names.size() < most_names) names.insert(name);
}

/// "12 (waist)": a node is asked for by its id or by its place.
std::string node_name(const RawChannel& raw) {
  return shown(raw.node) + (raw.place.empty() ? "" : " (" + shown(raw.place) + ")");
}

}  // namespace

RecordedMessages::RecordedMessages(DeviceChoice choice, std::shared_ptr<const RecordingParts> parts)
    : choice_(std::move(choice)), any_node_(choice_.node.empty()), parts_(std::move(parts)) {}

Duration RecordedMessages::utc_minus_host() const {
  if (!facts_) return {};
  return facts_->anchor.utc.time_since_epoch() - facts_->anchor.raw.time_since_epoch();
}

Result<void> RecordedMessages::feed(std::string_view piece, const TakeMessage& take) {
  reader_.feed(piece);
  return take_records(take);
}

Result<void> RecordedMessages::next_part(const TakeMessage& take) {
  reader_.end();
  KA_TRY(take_records(take));
  judge_file();
  reader_ = {};
  guard_ = {};
  ++part_;
  return {};
}

Result<void> RecordedMessages::finish(const TakeMessage& take) {
  reader_.end();
  KA_TRY(take_records(take));
  if (!facts_) {
    return Failure(Error{file(), 0, "a recording of kinalign's",
                         reader_.is_mcap() ? "an MCAP file of another program" : "no MCAP file"});
  }
  judge_end();
  if (any_node_ && nodes_.size() > 1) {
    return Failure(Error{file(), 0,
                         fmt::format("one node of stream {}: select.node", choice_.stream),
                         fmt::format("{}", fmt::join(nodes_, ", "))});
  }
  if (meant_.size() > 1) {
    return Failure(Error{
        file(), 0,
        fmt::format("one node of stream {} that is called {}", choice_.stream, shown(choice_.node)),
        fmt::format("{}", fmt::join(meant_, ", "))});
  }
  if (chosen_) return {};
  if (streams_.count(choice_.stream) == 0) {
    return Failure(
        Error{file(), 0,
              fmt::format("select.stream, or a stream's name, of {}",
                          streams_.empty() ? "those recorded"
                                           : fmt::format("{}", fmt::join(streams_, ", "))),
              streams_.empty() ? "a recording in which nothing was heard"
                               : "'" + shown(choice_.stream) + "'"});
  }
  const bool node = !nodes_.empty();
  return Failure(Error{
      file(), 0,
      fmt::format("of stream {} {}", choice_.stream,
                  node ? fmt::format("node {}", fmt::join(nodes_, ", "))
                       : fmt::format("select.sender {}", fmt::join(roll_.hosts(), ", "))),
      "'" + shown(node ? choice_.node : choice_.sender) + "'", ErrorKind::no_rows_in_recording});
}

Result<void> RecordedMessages::take_records(const TakeMessage& take) {
  while (const auto record = reader_.next()) KA_TRY(take_one(*record, take));
  return {};
}

Result<void> RecordedMessages::take_one(const McapRecord& record, const TakeMessage& take) {
  if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
    if (!facts_) facts_ = to_facts(*metadata);
    if (const auto end = to_end(*metadata)) end_ = end;
    ended_ = ended_ || ending_of(*metadata) != Ending::none;
  } else if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
    if (attachment->name == choice_.stream + ".bvh") skeleton_ = attachment->data;
  } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
    add(*channel);
  } else if (const auto* message = std::get_if<McapMessage>(&record)) {
    return take_message(*message, take);
  }
  return {};
}

void RecordedMessages::take_mark(const McapMessage& message) {
  if (by_file_.marks.size() >= most_marks) {
    ++more_marks_;
    return;
  }
  auto said = to_mark(message.data);
  if (!said) return;
  const Time at{Duration{static_cast<std::int64_t>(message.log_time)}};
  by_file_.marks.push_back({at, name_of(said->mark.kind), std::move(said->mark.text),
                            said->mark.latency, std::move(said->source)});
}

Result<void> RecordedMessages::take_message(const McapMessage& message, const TakeMessage& take) {
  if (!guard_.believes(message, reader_.unchecked())) return {};
  if (mark_channels_.contains(message.channel)) {
    if (message.log_time <= latest_log_time && !stands_elsewhere(*parts_, part_, message)) {
      take_mark(message);
    }
    return {};
  }
  const auto found = channels_.find(message.channel);
  if (found == channels_.end() || !facts_ || message.log_time > latest_log_time) return {};
  if (stands_elsewhere(*parts_, part_, message)) return {};
  Channel& from = found->second;
  const auto log = Duration{static_cast<std::int64_t>(message.log_time)};
  const HostTime arrival{log - utc_minus_host()};
  if (from.sender) roll_.hear(*from.sender, arrival);
  if (!from.wanted) return {};
  const std::uint32_t step = message.sequence - from.last_number.value_or(message.sequence - 1);
  from.last_number = message.sequence;
  if (step > 1 && step < 1U << 31U) missing_ += step - 1;
  return take({&from.raw, message.channel, arrival, message.data});
}

/// Each chunk names its channels again, and so does a summary, which may be damaged.
void RecordedMessages::add(const McapChannel& defined) {
  const McapChannel* proved = proved_channel(*parts_, defined.id);
  const McapChannel& channel = proved == nullptr ? defined : *proved;
  auto raw = to_raw(channel);
  if (channel.topic == marks_topic && !channels_.contains(channel.id)) {
    mark_channels_.insert(channel.id);
  }
  if (!raw || mark_channels_.contains(channel.id)) return;
  const auto [at, fresh] = channels_.try_emplace(channel.id);
  if (!fresh) return;
  at->second = {*raw, is_wanted(*raw), place_on_roll(*raw), {}};
  if (at->second.wanted && !chosen_ && raw->protocol != exchange_encoding) chosen_ = *raw;
}

bool RecordedMessages::is_wanted(const RawChannel& raw) {
  remember(streams_, shown(raw.stream));
  if (raw.stream != choice_.stream) return false;
  if (!raw.node.empty()) {  // a node may come from another address after a while
    remember(nodes_, node_name(raw));
    if (choice_.node.empty()) choice_.node = raw.node;
    const bool is_meant =
        raw.node == choice_.node || (!raw.place.empty() && raw.place == choice_.node);
    if (is_meant) remember(meant_, node_name(raw));
    return is_meant;
  }
  const std::string host = host_of(raw.sender);
  if (choice_.sender.empty()) choice_.sender = host;
  if (choice_.passed_over.contains(raw.sender)) return false;
  return host == choice_.sender || raw.sender == choice_.sender;
}

std::optional<std::size_t> RecordedMessages::place_on_roll(const RawChannel& raw) {
  const bool device = raw.stream == choice_.stream && raw.protocol != exchange_encoding;
  return device && raw.node.empty() ? std::optional(roll_.add(raw.sender)) : std::nullopt;
}

void RecordedMessages::judge_file() {
  for (Finding finding : reader_.findings()) {
    finding.what.file = file();
    by_file_.findings.push_back(std::move(finding));
  }
  append(by_file_.findings, judge_strays(file(), guard_));
  if (!reader_.closed()) {
    by_file_.findings.push_back(
        {Severity::warning, Error{file(), 0, "a file that was closed", "one that breaks off"},
         "everything up to the break was read", "kinalign recover makes a whole file of it"});
  }
}

void RecordedMessages::judge_end() {
  judge_file();
  if (!ended_ && reader_.closed()) by_file_.findings.push_back(ends_before(file()));
  if (more_marks_ > 0) {
    by_file_.findings.push_back({Severity::warning,
                                 Error{file(), 0, fmt::format("at most {} marks", most_marks),
                                       fmt::format("{} more", more_marks_)},
                                 "they are left out", ""});
  }
  if (end_ && end_->dropped > 0) {
    by_file_.findings.push_back({Severity::warning,
                                 Error{file(), 0, "every message that reached the recorder",
                                       fmt::format("{} fewer, of all devices", end_->dropped)},
                                 "the disk was too slow for too long, and memory full", ""});
  }
  if (missing_ > 0) {
    findings_.push_back(
        {Severity::warning,
         Error{file(), 0, "every message that reached the recorder",
               fmt::format("{} of {} missing between others", missing_, choice_.stream)},
         "damage in the file, or a recording that went on in another part", ""});
  }
}

}  // namespace kinalign
