// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/device_reader.h"

#include "kinalign/formats/bvh/head.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/beside.h"
#include "kinalign/recording/streams/sender_choice.h"

#include <array>
#include <charconv>
#include <utility>
#include <vector>

namespace kinalign {

namespace {

DeviceProtocol rows_of(Protocol protocol) {
  switch (protocol) {
    case Protocol::nodes:
      return node_protocol();
    case Protocol::noitom:
      return noitom_protocol();
    case Protocol::xsens:
      return xsens_protocol();
    case Protocol::kinect:
      return kinect_protocol();
    case Protocol::slimevr:
      break;
  }
  return slimevr_protocol();
}

Result<DeviceProtocol> protocol_of(const RawChannel& channel, const DeviceWish& wish) {
  const std::string& file = wish.file.path;
  const auto protocol = find_recorded_protocol(channel.protocol);
  if (!wish.skeleton.empty() && !(protocol && row_of(*protocol).needs_skeleton)) {
    return Failure(Error{file, 0, "a skeleton of a noitom stream alone",
                         "one of " + shown(channel.stream) + ", of " + shown(channel.protocol)});
  }
  if (wish.trackers && protocol && row_of(*protocol).has_trackers) return xsens_tracker_protocol();
  if (wish.trackers) {
    return Failure(Error{file, 0, "trackers of an xsens stream",
                         shown(channel.stream) + ", of " + shown(channel.protocol)});
  }
  if (protocol) return rows_of(*protocol);
  std::string known;
  for (const Protocol one :
       {Protocol::nodes, Protocol::kinect, Protocol::noitom, Protocol::xsens, Protocol::slimevr}) {
    known += (known.empty() ? "" : ", ") + std::string(row_of(one).recorded_name);
  }
  return Failure(Error{file, 0, "of stream " + shown(channel.stream) + " one of: " + known,
                       "'" + shown(channel.protocol) + "', of which no rows can be made yet",
                       ErrorKind::no_rows_in_recording});
}

std::string selected(const StreamOptions& options, const char* key, const std::string& otherwise) {
  const auto found = options.select.find(key);
  return found == options.select.end() ? otherwise : found->second;
}

/// "10.0.0.21" and "1" of "10.0.0.21/1", a tracker's sensor; of other nodes this says nothing.
std::pair<std::string, std::string> tracker_of(const std::string& node) {
  const auto slash = node.rfind('/');
  const bool has_sensor = slash != std::string::npos && slash + 1 < node.size() &&
                          node.find_first_not_of("0123456789", slash + 1) == std::string::npos;
  if (!has_sensor) return {node, ""};
  return {node.substr(0, slash), node.substr(slash + 1)};
}

Result<DeviceWish> wish_of(const StreamOptions& options, const StreamFile& file) {
  for (const auto& [name, value] : options.select) {
    if (name == "stream" || name == "node" || name == "sender" || name == "body") continue;
    if (name == "kind" && (value == "poses" || value == "trackers")) continue;
    return Failure(Error{file.path, 0,
                         "select by stream, node, sender, body or kind (poses, trackers)",
                         shown(name) + " = " + shown(value)});
  }
  DeviceWish wish{options, file, {}, {}, {}, {}};
  wish.trackers = selected(options, "kind", "poses") == "trackers";
  wish.choice = {selected(options, "stream", options.name), selected(options, "node", file.node),
                 selected(options, "sender", "")};
  const auto [tracker, sensor] = tracker_of(wish.choice.node);
  if (wish.choice.sender.empty()) wish.choice.sender = tracker;
  const std::string body = selected(options, "body", sensor);
  if (body.empty()) return wish;
  std::uint64_t id = 0;
  const auto [behind, fault] = std::from_chars(body.data(), body.data() + body.size(), id);
  if (fault == std::errc{} && behind == body.data() + body.size()) {
    wish.body = id;
    return wish;
  }
  return Failure(Error{file.path, 0, "select.body: a whole number", "'" + shown(body) + "'"});
}

/// Pieces of the files that a recording went on in.
class FurtherPieces {
 public:
  FurtherPieces(FileSystem& files, std::shared_ptr<const RecordingParts> parts)
      : files_(&files), parts_(std::move(parts)) {}

  /// Absent behind the last one.
  Result<std::optional<std::string_view>> next(RecordedMessages& messages,
                                               const TakeMessage& take) {
    for (;;) {
      if (!file_) {
        if (part_ == parts_->size()) return std::nullopt;
        KA_TRY(messages.next_part(take));
        file_.emplace(KA_TRY(InputFile::open(*files_, parts_->at(part_++).path)));
      }
      const std::string_view piece = KA_TRY(file_->next());
      if (!piece.empty()) return piece;
      file_.reset();
    }
  }

 private:
  FileSystem* files_;
  std::shared_ptr<const RecordingParts> parts_;
  std::size_t part_ = 1;
  std::optional<InputFile> file_;
};

/// The second pass over the files.
template <class Frames, class ReaderType>
class RecordingReader final : public ReaderType {
 public:
  RecordingReader(FileSystem& files, const DeviceWish& wish,
                  std::shared_ptr<const HeardDevice> heard,
                  std::unique_ptr<DeviceRows<Frames>> rows)
      : messages_(wish.choice, wish.parts),
        further_(files, wish.parts),
        heard_(std::move(heard)),
        rows_(std::move(rows)) {}

  Result<void> feed(std::string_view piece, Frames& out) override {
    return messages_.feed(piece, [&](const RecordedMessage& m) { return rows_->take(m, out); });
  }
  Result<bool> read_further(Frames& out) override {
    const TakeMessage take = [&](const RecordedMessage& m) { return rows_->take(m, out); };
    const auto piece = KA_TRY(further_.next(messages_, take));
    if (piece) KA_TRY(messages_.feed(*piece, take));
    return piece.has_value();
  }
  Result<void> finish(Frames& out) override {
    KA_TRY(messages_.finish([&](const RecordedMessage& m) { return rows_->take(m, out); }));
    KA_TRY(rows_->finish(out));
    append(this->findings, messages_.findings());
    append(this->findings, heard_->findings);
    append(this->findings, rows_->findings);
    return {};
  }
  const typename ReaderType::Header* header() const override { return rows_->header(); }

 private:
  RecordedMessages messages_;
  FurtherPieces further_;
  std::shared_ptr<const HeardDevice> heard_;
  std::unique_ptr<DeviceRows<Frames>> rows_;
};

AnyReader reader_of(FileSystem& files, const DeviceWish& wish,
                    const std::shared_ptr<const HeardDevice>& heard, AnyDeviceRows rows) {
  return std::visit(
      [&]<class Frames>(std::unique_ptr<DeviceRows<Frames>>& one) -> AnyReader {
        using Made = Reader<typename DeviceRows<Frames>::Header, Frames>;
        return std::make_unique<RecordingReader<Frames, Made>>(files, wish, heard, std::move(one));
      },
      rows);
}

/// The first pass, of one choice of a sender.
class Listening {
 public:
  explicit Listening(const DeviceWish& wish) : wish_(wish), messages_(wish.choice, wish.parts) {}

  Result<void> feed(std::string_view piece) {
    return messages_.feed(piece, [this](const RecordedMessage& m) { return take(m); });
  }
  Result<void> next_part() {
    return messages_.next_part([this](const RecordedMessage& m) { return take(m); });
  }
  /// Fails where the file has no such device.
  Result<void> end() {
    return messages_.finish([this](const RecordedMessage& m) { return take(m); });
  }
  /// Fails where no rows could be made of it.
  Result<HeardDevice> heard() {
    HeardDevice heard;
    heard.channel = *messages_.chosen();
    heard.skeleton = wish_.skeleton.empty() ? messages_.skeleton() : wish_.skeleton;
    heard.utc_minus_host = messages_.utc_minus_host();
    KA_TRY(begin(heard.channel));
    KA_TRY(listener_->finish(heard));
    return heard;
  }
  const DeviceProtocol& protocol() const { return *protocol_; }
  const SaidByFile& by_file() const { return messages_.by_file(); }
  const SenderRoll& senders() const { return messages_.senders(); }
  const RawChannel& channel() const { return *messages_.chosen(); }

 private:
  Result<void> begin(const RawChannel& channel) {
    if (listener_) return {};
    protocol_ = KA_TRY(protocol_of(channel, wish_));
    listener_ = protocol_->listen(wish_);
    return {};
  }
  Result<void> take(const RecordedMessage& message) {
    if (!messages_.chosen()) {  // exchanges before the first payload
      if (early_.size() < most_early) early_.push_back({message, std::string(message.payload)});
      return {};
    }
    KA_TRY(begin(*messages_.chosen()));
    for (Early& early : early_) {
      early.message.payload = early.payload;
      listener_->take(early.message);
    }
    early_.clear();
    listener_->take(message);
    return {};
  }

  static constexpr std::size_t most_early = 1000;
  struct Early {
    RecordedMessage message;
    std::string payload;
  };
  DeviceWish wish_;
  RecordedMessages messages_;
  std::vector<Early> early_;
  std::optional<DeviceProtocol> protocol_;
  std::unique_ptr<DeviceListener> listener_;
};

Result<std::unique_ptr<Listening>> listen_once(FileSystem& files, const DeviceWish& wish,
                                               const Progress& progress) {
  auto listening = std::make_unique<Listening>(wish);
  for (const RecordingPart& part : *wish.parts) {
    if (&part != &wish.parts->front()) KA_TRY(listening->next_part());
    InputFile input = KA_TRY(InputFile::open(files, part.path));
    std::uint64_t done = 0;
    for (;;) {
      const std::string_view piece = KA_TRY(input.next());
      if (piece.empty()) break;
      KA_TRY(listening->feed(piece));
      done += piece.size();
      if (!go_on(progress, "listening", done, input.size())) {
        return Failure(interruption(part.path));
      }
    }
  }
  KA_TRY(listening->end().map_error(
      [&](Error error) { return with_nodes(files, wish, std::move(error), progress); }));
  return listening;
}

/// With what stands in other files.
Result<DeviceWish> whole_wish(FileSystem& files, const StreamOptions& options,
                              const StreamFile& file, const Progress& progress) {
  DeviceWish wish = KA_TRY(wish_of(options, file));
  wish.parts =
      std::make_shared<const RecordingParts>(KA_TRY(parts_from(files, file.path, progress)));
  if (!options.skeleton.empty()) wish.skeleton = KA_TRY(read_bvh_head(files, options.skeleton));
  return wish;
}

RecordedDevice device_of(FileSystem& files, const DeviceWish& wish, const Listening& listening,
                         HeardDevice heard) {
  SaidByFile by_file = listening.by_file();
  append(by_file.findings, judge_parts(*wish.parts, PartsBehind::read));
  append(by_file.findings, judge_namesakes(files, wish.parts->front().path));
  const auto shared = std::make_shared<const HeardDevice>(std::move(heard));
  std::vector<std::string> further;
  for (const RecordingPart& part : *wish.parts) further.push_back(part.path);
  further.erase(further.begin());
  if (!wish.skeleton.empty()) further.push_back(wish.options.skeleton);
  return {shared,
          [&files, wish, shared, protocol = listening.protocol()]() -> Result<AnyReader> {
            return reader_of(files, wish, shared, protocol.rows(wish, shared));
          },
          std::move(further), std::move(by_file)};
}

}  // namespace

Result<RecordedDevice> listen(FileSystem& files, const StreamOptions& options,
                              const StreamFile& file, const Progress& progress) {
  DeviceWish wish = KA_TRY(whole_wish(files, options, file, progress));
  const bool any_sender = wish.choice.sender.empty();
  auto listening = KA_TRY(listen_once(files, wish, progress));
  const SenderRoll senders = listening->senders();
  DeviceChoice taken = wish.choice;  // of that pass
  if (any_sender && listening->channel().node.empty()) {
    taken.sender = host_of(listening->channel().sender);
  }
  std::optional<Error> why;  // nothing came of the busiest one
  for (const DeviceChoice& choice : choices(wish.choice, senders)) {
    wish.choice = choice;
    if (taken != choice) listening = KA_TRY(listen_once(files, wish, progress));
    taken = choice;
    auto heard = listening->heard();
    if (!heard) {
      if (!why) why = with_senders(heard.error(), choice.sender, senders);
      continue;
    }
    append(heard->findings, judge_senders(wish, any_sender, senders));
    return device_of(files, wish, *listening, std::move(*heard));
  }
  return Failure(*why);
}

}  // namespace kinalign
