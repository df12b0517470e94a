// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace kinalign {

namespace {

std::array<DeviceProtocol, 5> protocols() {
  return {node_protocol(), kinect_protocol(), noitom_protocol(), xsens_protocol(),
          slimevr_protocol()};
}

Result<DeviceProtocol> protocol_of(const RawChannel& channel, const std::string& file) {
  for (const DeviceProtocol& one : protocols()) {
    if (one.name == channel.protocol) return one;
  }
  std::string known;
  for (const DeviceProtocol& one : protocols()) {
    known += (known.empty() ? "" : ", ") + std::string(one.name);
  }
  return Failure(Error{file, 0, "of stream " + shown(channel.stream) + " one of: " + known,
                       "'" + shown(channel.protocol) + "', of which no rows can be made yet"});
}

std::string selected(const StreamOptions& options, const char* key, const std::string& otherwise) {
  const auto found = options.select.find(key);
  return found == options.select.end() ? otherwise : found->second;
}

Result<DeviceWish> wish_of(const StreamOptions& options, const StreamFile& file) {
  for (const auto& [name, value] : options.select) {
    if (name == "stream" || name == "node" || name == "sender" || name == "body") continue;
    return Failure(Error{file.path, 0, "select by stream, node, sender or body",
                         shown(name) + " = " + shown(value)});
  }
  DeviceWish wish{options, file, {}, {}};
  wish.choice = {selected(options, "stream", options.name), selected(options, "node", file.node),
                 selected(options, "sender", "")};
  if (wish.choice.sender.empty()) wish.choice.sender = wish.choice.node;  // of a tracker
  const std::string body = selected(options, "body", "");
  if (body.empty()) return wish;
  std::uint64_t id = 0;
  const auto [behind, fault] = std::from_chars(body.data(), body.data() + body.size(), id);
  if (fault == std::errc{} && behind == body.data() + body.size()) {
    wish.body = id;
    return wish;
  }
  return Failure(Error{file.path, 0, "select.body: a whole number", "'" + shown(body) + "'"});
}

/// The second pass over the file.
template <class Frames, class ReaderType>
class RecordingReader final : public ReaderType {
 public:
  RecordingReader(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard,
                  std::unique_ptr<DeviceRows<Frames>> rows)
      : messages_(wish.choice, wish.file.path), heard_(std::move(heard)), rows_(std::move(rows)) {}

  Result<void> feed(std::string_view piece, Frames& out) override {
    return messages_.feed(piece, [&](const RecordedMessage& m) { return rows_->take(m, out); });
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
  std::shared_ptr<const HeardDevice> heard_;
  std::unique_ptr<DeviceRows<Frames>> rows_;
};

AnyReader reader_of(const DeviceWish& wish, const std::shared_ptr<const HeardDevice>& heard,
                    AnyDeviceRows rows) {
  return std::visit(
      [&]<class Frames>(std::unique_ptr<DeviceRows<Frames>>& one) -> AnyReader {
        using Made = Reader<typename DeviceRows<Frames>::Header, Frames>;
        return std::make_unique<RecordingReader<Frames, Made>>(wish, heard, std::move(one));
      },
      rows);
}

/// The first pass.
class Listening {
 public:
  explicit Listening(const DeviceWish& wish)
      : wish_(wish), messages_(wish.choice, wish.file.path) {}

  Result<void> feed(std::string_view piece) {
    return messages_.feed(piece, [this](const RecordedMessage& m) { return take(m); });
  }
  Result<HeardDevice> finish() {
    KA_TRY(messages_.finish([this](const RecordedMessage& m) { return take(m); }));
    HeardDevice heard;
    heard.channel = *messages_.chosen();
    heard.skeleton = messages_.skeleton();
    heard.utc_minus_host = messages_.utc_minus_host();
    KA_TRY(begin(heard.channel));
    KA_TRY(listener_->finish(heard));
    return heard;
  }
  const DeviceProtocol& protocol() const { return *protocol_; }

 private:
  Result<void> begin(const RawChannel& channel) {
    if (listener_) return {};
    protocol_ = KA_TRY(protocol_of(channel, wish_.file.path));
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

/// Mocap is the most exact and has the highest rate: its stamps become the grid.
constexpr int kinect_rank = 1;
int rank_of(std::string_view protocol) {
  if (protocol == "noitom" || protocol == "xsens") return 0;
  return protocol == "kinect" ? kinect_rank : 2;
}

/// What a manifest calls one of several that are a stream: trackers are told apart by their
/// addresses; of mocap and Kinects the first is the one.
std::string node_name(const RawChannel& raw) {
  if (raw.protocol == "slimevr") return host_of(raw.sender);
  return raw.place.empty() ? raw.node : raw.place;
}

}  // namespace

bool looks_like_recording(std::string_view head) { return head.starts_with(mcap_magic); }

Result<RecordedDevice> listen(FileSystem& files, const StreamOptions& options,
                              const StreamFile& file, const Progress& progress) {
  const DeviceWish wish = KA_TRY(wish_of(options, file));
  InputFile input = KA_TRY(InputFile::open(files, file.path));
  Listening listening(wish);
  std::uint64_t done = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(input.next());
    if (piece.empty()) break;
    KA_TRY(listening.feed(piece));
    done += piece.size();
    if (!go_on(progress, "listening", done, input.size())) return Failure(interruption(file.path));
  }
  auto heard = std::make_shared<const HeardDevice>(KA_TRY(listening.finish()));
  return RecordedDevice{heard,
                        [wish, heard, protocol = listening.protocol()]() -> Result<AnyReader> {
                          return reader_of(wish, heard, protocol.rows(wish, heard));
                        }};
}

Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path) {
  if (!survey.facts)
    return Failure(Error{path, 0, "a recording of kinalign's", "another MCAP file"});
  struct Device {
    int rank = 0;
    StreamOptions options;
  };
  std::vector<Device> devices;
  for (const ChannelSurvey& one : survey.channels) {
    const auto raw = to_raw(one.channel);
    if (!raw || raw->protocol == exchange_encoding || one.messages == 0) continue;
    auto device = std::find_if(devices.begin(), devices.end(),
                               [&](const Device& d) { return d.options.name == raw->stream; });
    if (device == devices.end()) {
      device = devices.insert(device, {rank_of(raw->protocol), {}});
      device->options.name = raw->stream;
      device->options.select = {{"stream", raw->stream}};
    }
    std::vector<StreamFile>& streams = device->options.files;
    std::string node = node_name(*raw);
    const auto same = [&](const StreamFile& file) { return file.node == node; };
    if (std::any_of(streams.begin(), streams.end(), same)) continue;
    streams.push_back({path, std::move(node)});
  }
  if (devices.empty()) {
    return Failure(Error{path, 0, "a recording of devices", "one in which none was heard"});
  }
  std::stable_sort(devices.begin(), devices.end(),
                   [](const Device& a, const Device& b) { return a.rank < b.rank; });
  Manifest manifest;
  manifest.subject = survey.facts->subject;
  manifest.action = survey.facts->action;
  for (Device& device : devices) {
    const bool follows = !manifest.streams.empty() && devices.front().rank <= kinect_rank;
    if (follows && device.rank == kinect_rank) manifest.spaces[device.options.name].method = "fit";
    manifest.streams.push_back(std::move(device.options));
  }
  return manifest;
}

}  // namespace kinalign
