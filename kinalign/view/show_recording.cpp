// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/show_recording.h"

#include "kinalign/view/shown_file.h"
#include "kinalign/view/shown_pace.h"
#include "kinalign/view/shown_rows.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

namespace {

/// A stream that is being written. show_streams() needs the same two functions for all kinds of
/// streams: one returns the time of the next sample, the other writes the sample.
class Showing {
 public:
  virtual ~Showing() = default;
  /// Returns the time of the next sample; absent after the last one.
  virtual std::optional<Time> next() const = 0;
  virtual Result<void> show(ShownFile& out) = 0;
};

const Skeleton& joints_of(const ClipInput& input) { return input.skeleton; }
const std::vector<std::string>& joints_of(const PointInput& input) { return input.joint_names; }

/// Writes the messages of a skeleton or of points (Input: ClipInput or PointInput). Every frame
/// becomes a message for plots. Transforms are drawn by viewers, so they are written only for some
/// frames (ShownPace).
template <class Input>
class ShowJoints {
 public:
  static Result<ShowJoints> begin(const std::string& stream, const Input& input, ShownFile& out) {
    constexpr bool clip = std::is_same_v<Input, ClipInput>;
    ShowJoints show;
    show.stream_ = stream;
    show.input_ = &input;
    show.transforms_ = KA_TRY(out.add_channel("/" + stream + "/transforms", transforms_schema()));
    show.plotted_ = KA_TRY(out.add_channel("/" + stream + (clip ? "/pose" : "/points"),
                                           clip ? pose_schema() : points_schema()));
    return show;
  }
  template <class Frames>
  Result<void> operator()(const Frames& frames, std::size_t t, const ShownTime& time, bool due,
                          ShownFile& out) const {
    const auto& joints = joints_of(*input_);
    const Time device = frames.stamps[t];
    if (due) {
      KA_TRY(
          out.add(transforms_, time.at, device, transforms_json(stream_, joints, frames, t, time)));
    }
    return out.add(plotted_, time.at, device, joints_json(joints, frames, t, time));
  }

 private:
  std::string stream_;
  const Input* input_ = nullptr;
  std::uint16_t transforms_ = 0, plotted_ = 0;
};

/// Writes one channel for each node. Nodes have no position, so they have no transforms.
class ShowImu {
 public:
  static Result<ShowImu> begin(const std::string& stream, const ImuInput& input, ShownFile& out) {
    ShowImu show;
    show.input_ = &input;
    for (const std::string& node : input.node_names) {
      show.nodes_.push_back(KA_TRY(out.add_channel("/" + stream + "/" + node, imu_schema())));
    }
    return show;
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
  const ImuInput* input_ = nullptr;
  std::vector<std::uint16_t> nodes_;
};

/// Reads a stream block by block. `block_` contains the samples from `row_` on, and next_ is the
/// time of the first of them. Both are updated after each sample.
template <class Frames, class Show>
class StreamShowing final : public Showing {
 public:
  StreamShowing(const RecordedStream& stream, Pass<Frames> pass, Show show)
      : clock_(&stream.clock), pass_(std::move(pass)), show_(std::move(show)) {}

  Result<void> begin() { return fill(); }
  std::optional<Time> next() const override { return next_; }
  Result<void> show(ShownFile& out) override {
    // The half-width comes from the device's clock model at this stamp.
    const ShownTime time{*next_, half_width(*clock_, block_.stamps[row_])};
    KA_TRY(show_(block_, row_, time, pace_.shows(time.at), out));
    ++row_;
    return fill();
  }

 private:
  Result<void> fill() {
    // The loop repeats, because a block may be empty although more blocks follow.
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
  std::optional<Time> next_;
  ShownPace pace_;  // selects the frames that are written as transforms
};

/// Adds the stream's channels and reads its first block.
template <class Input, class Frames>
Result<std::unique_ptr<Showing>> showing_of(const RecordedStream& stream, const Input& input,
                                            const Passes<Frames>& passes, ShownFile& out) {
  using Show = std::conditional_t<std::is_same_v<Input, ImuInput>, ShowImu, ShowJoints<Input>>;
  Show show = KA_TRY(Show::begin(stream.name, input, out));
  auto showing =
      std::make_unique<StreamShowing<Frames, Show>>(stream, KA_TRY(passes()), std::move(show));
  KA_TRY(showing->begin());
  return std::unique_ptr<Showing>(std::move(showing));
}

/// Copies the recording's own JSON messages: marks, counts, the host's clocks. The messages and
/// their log times are unchanged. Chunks are read one at a time.
class ShowJson final : public Showing {
 public:
  ShowJson(MessagePass pass, std::map<std::uint16_t, std::uint16_t> channels)
      : pass_(std::move(pass)), channels_(std::move(channels)) {}

  static Result<std::unique_ptr<Showing>> begin(const RecordingSource& recording, ShownFile& out) {
    // The ids of channels differ between the two files, because the new file has other channels
    // too.
    std::map<std::uint16_t, std::uint16_t> channels;  // id in the recording -> id in the new file
    std::vector<std::uint16_t> ids;
    for (const JsonChannel& one : recording.json_channels()) {
      channels[one.id] = KA_TRY(out.add_channel(one.topic, one.schema));
      ids.push_back(one.id);
    }
    auto json = std::make_unique<ShowJson>(recording.messages_of(ids), std::move(channels));
    KA_TRY(json->fill());
    return std::unique_ptr<Showing>(std::move(json));
  }

  std::optional<Time> next() const override {
    if (row_ == messages_.size()) return std::nullopt;
    return utc_time(static_cast<std::int64_t>(messages_[row_].log_time));
  }
  Result<void> show(ShownFile& out) override {
    const Message& message = messages_[row_];
    // These messages have only one time, the host's.
    const Time at = *next();
    KA_TRY(out.add(channels_.at(message.channel), at, at, message.json));
    ++row_;
    return fill();
  }

 private:
  struct Message {
    std::uint16_t channel = 0;
    std::uint64_t log_time = 0;
    std::string json;
  };

  Result<void> fill() {
    while (!ended_ && row_ == messages_.size()) {
      messages_.clear();
      row_ = 0;
      ended_ = !KA_TRY(pass_.next_chunk([this](const ChunkMessage& message) -> Result<void> {
        messages_.push_back({message.channel, message.log_time, std::string(message.data)});
        return {};
      }));
    }
    return {};
  }

  MessagePass pass_;
  std::map<std::uint16_t, std::uint16_t> channels_;
  std::vector<Message> messages_;  // the messages of a chunk
  std::size_t row_ = 0;
  bool ended_ = false;
};

/// Writes all streams in the order of their samples' times, because viewers need this order.
/// `rows`: number of samples. Sorted streams are merged: `next` is ordered by time and contains
/// each stream at most once.
Result<void> show_streams(const std::vector<std::unique_ptr<Showing>>& streams, std::uint64_t rows,
                          ShownFile& shown, const Progress& progress) {
  // Time of the next sample, and the index of its stream.
  std::set<std::pair<Time, std::size_t>> next;
  // A stream that has ended is not inserted again.
  const auto wait = [&](std::size_t i) {
    if (const auto at = streams[i]->next()) next.emplace(*at, i);
  };
  for (std::size_t i = 0; i < streams.size(); ++i) wait(i);
  for (std::uint64_t done = 1; !next.empty(); ++done) {
    const std::size_t first = next.extract(next.begin()).value().second;
    KA_TRY(streams[first]->show(shown));
    wait(first);
    // Progress is reported seldom, because a call for each sample would cost more than the sample.
    if (done % 1024 == 0 && !go_on(progress, "converting", done, rows)) {
      return Failure(interruption());
    }
  }
  return {};
}

}  // namespace

Result<Findings> show_recording(FileSystem& files, const Recording& recording,
                                const ShowFiles& paths, const Progress& progress) {
  // The file gets its name in commit(), so a failed conversion leaves no file.
  OutputFile file = KA_TRY(OutputFile::create(files, paths.out, paths.overwrite));
  ShownFile shown(file);
  KA_TRY(shown.begin());
  std::unique_ptr<Showing> own;
  if (paths.recording != nullptr) own = KA_TRY(ShowJson::begin(*paths.recording, shown));
  std::vector<std::unique_ptr<Showing>> streams;
  std::uint64_t rows = 0;
  for (const RecordedStream& stream : recording.streams) {
    streams.push_back(KA_TRY(std::visit(
        [&](const auto& input) { return showing_of(stream, input, input.passes, shown); },
        stream.data)));
    rows += stream.survey.samples;
  }
  if (own) streams.push_back(std::move(own));
  KA_TRY(show_streams(streams, rows, shown, progress));
  KA_TRY(shown.finish());
  KA_TRY(file.commit());
  return shown.findings();
}

}  // namespace kinalign
