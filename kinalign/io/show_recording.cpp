// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/show_recording.h"

#include "kinalign/io/recording_survey.h"
#include "kinalign/io/shown_file.h"
#include "kinalign/io/shown_rows.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

namespace {

// Viewers draw no faster, and 59 joints are 12 kB of text.
constexpr Duration between_transforms = std::chrono::milliseconds(33);

/// A stream in the middle of being shown.
class Showing {
 public:
  virtual ~Showing() = default;
  /// When its next sample is; absent behind the last.
  virtual std::optional<Time> next() const = 0;
  virtual Result<void> show(ShownFile& out) = 0;
};

/// Where a kind of stream goes.
class ShowClip {
 public:
  ShowClip(const std::string& stream, const ClipInput& input, ShownFile& out)
      : stream_(stream),
        input_(&input),
        transforms_(out.add_channel("/" + stream + "/transforms", transforms_schema())),
        poses_(out.add_channel("/" + stream + "/pose", pose_schema())) {}
  Result<void> operator()(const ClipFrames& frames, std::size_t t, const ShownTime& time, bool due,
                          ShownFile& out) const {
    const Time device = frames.stamps[t];
    if (due) {
      KA_TRY(out.add(transforms_, time.at, device,
                     transforms_json(stream_, input_->skeleton, frames, t, time)));
    }
    return out.add(poses_, time.at, device, pose_json(input_->skeleton, frames, t, time));
  }

 private:
  std::string stream_;
  const ClipInput* input_;
  std::uint16_t transforms_, poses_;
};

class ShowPoints {
 public:
  ShowPoints(const std::string& stream, const PointInput& input, ShownFile& out)
      : stream_(stream),
        input_(&input),
        transforms_(out.add_channel("/" + stream + "/transforms", transforms_schema())),
        points_(out.add_channel("/" + stream + "/points", points_schema())) {}
  Result<void> operator()(const PointFrames& frames, std::size_t t, const ShownTime& time, bool due,
                          ShownFile& out) const {
    const Time device = frames.stamps[t];
    if (due) {
      KA_TRY(out.add(transforms_, time.at, device,
                     transforms_json(stream_, input_->joint_names, frames, t, time)));
    }
    return out.add(points_, time.at, device, points_json(input_->joint_names, frames, t, time));
  }

 private:
  std::string stream_;
  const PointInput* input_;
  std::uint16_t transforms_, points_;
};

class ShowImu {
 public:
  ShowImu(const std::string& stream, const ImuInput& input, ShownFile& out) : input_(&input) {
    for (const std::string& node : input.node_names) {
      std::string topic = "/" + stream;
      topic += "/" + node;
      nodes_.push_back(out.add_channel(std::move(topic), imu_schema()));
    }
  }
  Result<void> operator()(const ImuSamples& samples, std::size_t t, const ShownTime& time, bool,
                          ShownFile& out) const {
    for (std::size_t s = 0; s < nodes_.size(); ++s) {
      KA_TRY(out.add(nodes_[s], time.at, samples.stamps[t],
                     imu_json(input_->content, samples, t * nodes_.size() + s, time)));
    }
    return {};
  }

 private:
  const ImuInput* input_;
  std::vector<std::uint16_t> nodes_;
};

template <class Frames, class Show>
class StreamShowing final : public Showing {
 public:
  StreamShowing(const RecordedStream& stream, Pass<Frames> pass, Show show)
      : clock_(&stream.clock), pass_(std::move(pass)), show_(std::move(show)) {}

  Result<void> begin() { return fill(); }
  std::optional<Time> next() const override { return next_; }
  Result<void> show(ShownFile& out) override {
    const ShownTime time{*next_, half_width(*clock_, block_.stamps[row_])};
    const bool due = is_due(time.at);
    KA_TRY(show_(block_, row_, time, due, out));
    ++row_;
    return fill();
  }

 private:
  /// By a grid that moves on with what was shown: frames of 30 Hz that jitter are all shown.
  bool is_due(Time at) {
    if (due_ && at < *due_ && *due_ - at <= between_transforms) return false;
    const bool follows = due_ && at >= *due_ && at - *due_ < between_transforms;
    due_ = (follows ? *due_ : at) + between_transforms;
    return true;
  }
  Result<void> fill() {
    while (!ended_ && row_ >= block_.size()) {
      ended_ = !KA_TRY(pass_(block_));
      row_ = 0;
    }
    next_ = ended_ ? std::nullopt : std::optional(take_time(*clock_, block_.stamps[row_]));
    return {};
  }

  const TimeModel* clock_;
  Pass<Frames> pass_;
  Show show_;
  Frames block_;
  std::size_t row_ = 0;
  bool ended_ = false;
  std::optional<Time> next_, due_;  // due_: the next transforms
};

template <class Frames, class Show, class Input>
Result<std::unique_ptr<Showing>> showing_of(const RecordedStream& stream, const Input& input,
                                            ShownFile& out) {
  auto showing = std::make_unique<StreamShowing<Frames, Show>>(stream, KA_TRY(input.passes()),
                                                               Show(stream.name, input, out));
  KA_TRY(showing->begin());
  return std::unique_ptr<Showing>(std::move(showing));
}

Result<std::unique_ptr<Showing>> begin_stream(const RecordedStream& stream, ShownFile& out) {
  if (const auto* clip = std::get_if<ClipInput>(&stream.data)) {
    return showing_of<ClipFrames, ShowClip>(stream, *clip, out);
  }
  if (const auto* points = std::get_if<PointInput>(&stream.data)) {
    return showing_of<PointFrames, ShowPoints>(stream, *points, out);
  }
  return showing_of<ImuSamples, ShowImu>(stream, std::get<ImuInput>(stream.data), out);
}

/// The recording's own JSON: marks, counts, the host's clocks.
class JsonChannels {
 public:
  explicit JsonChannels(ShownFile& out) : out_(out) {}

  Result<void> take(const McapRecord& record) {
    if (const auto* schema = std::get_if<McapSchema>(&record)) {
      schemas_[schema->id] = *schema;
    } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
      add(*channel);
    } else if (const auto* message = std::get_if<McapMessage>(&record)) {
      const auto found = copied_.find(message->channel);
      if (found == copied_.end() || message->log_time > INT64_MAX) return {};
      const Time at = utc_time(static_cast<std::int64_t>(message->log_time));
      return out_.add(found->second, at, at, message->data);
    }
    return {};
  }

 private:
  void add(const McapChannel& channel) {
    const auto schema = schemas_.find(channel.schema_id);
    if (channel.message_encoding != "json" || copied_.contains(channel.id)) return;
    if (schema == schemas_.end()) return;
    copied_[channel.id] = out_.add_channel(channel.topic, schema->second);
  }

  ShownFile& out_;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, std::uint16_t> copied_;  // its id -> ours
};

/// Of what stands in two files the later one's.
Result<void> copy_json(FileSystem& files, const RecordingParts& parts, const Progress& progress,
                       ShownFile& shown) {
  JsonChannels channels(shown);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    McapReader reader;
    const auto take = [&](const McapRecord& record) -> Result<void> {
      const auto* message = std::get_if<McapMessage>(&record);
      if (message != nullptr && stands_later(parts, part, *message)) return {};
      return channels.take(record);
    };
    KA_TRY(read_recording(files, parts[part].path, reader, take, progress));
  }
  return {};
}

/// All streams by turns, in the order of their samples' times.
Result<void> show_streams(const std::vector<RecordedStream>& recorded, ShownFile& shown,
                          const Progress& progress) {
  std::vector<std::unique_ptr<Showing>> streams;
  std::uint64_t rows = 0, done = 0;
  for (const RecordedStream& stream : recorded) {
    streams.push_back(KA_TRY(begin_stream(stream, shown)));
    rows += stream.survey.samples;
  }
  for (;;) {
    const auto first =
        std::min_element(streams.begin(), streams.end(), [](const auto& a, const auto& b) {
          return a->next().value_or(Time::max()) < b->next().value_or(Time::max());
        });
    if (first == streams.end() || !(*first)->next()) return {};
    KA_TRY((*first)->show(shown));
    if (++done % 1024 == 0 && !go_on(progress, "converting", done, rows)) {
      return Failure(interruption());
    }
  }
}

}  // namespace

Result<Shown> show_recording(FileSystem& files, const Recording& recording, const ShowFiles& paths,
                             const Progress& progress) {
  OutputFile file = KA_TRY(OutputFile::create(files, paths.out, paths.overwrite));
  ShownFile shown(file);
  KA_TRY(shown.begin());
  KA_TRY(show_streams(recording.streams, shown, progress));
  KA_TRY(copy_json(files, paths.from, progress, shown));
  KA_TRY(shown.finish());
  KA_TRY(file.commit());
  return shown.counts();
}

}  // namespace kinalign
