// SPDX-License-Identifier: Apache-2.0
// Compares a simulated recording with its truth:
//   kinalign_truth_table [--summary] RECORDING TAKE TRUTH
// RECORDING is the input of align (recording.toml or .mcap), TAKE its output, TRUTH the truth.json
// of simulate. Prints two tables, the errors of time and of values, or a summary of five lines.
// Ends with 1 if the truth of a certified stamp lies outside its interval.
#include "apps/kinalign/verbs/inputs.h"
#include "tools/truth_table/summary.h"

#include "kinalign/documents/truth_json.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/motion/interpolation/clip_motion.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/simulate/rehearsal/judge_recording.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace kinalign {

namespace {

constexpr std::size_t most_text = std::size_t{1} << 30;

struct Names {
  std::string recording, take, truth;
  bool summary = false;
};

struct Opened {
  Recording recording;
  std::optional<RecordingFacts> facts;  // facts of a recording that was received over the network
};

Result<Opened> open(FileSystem& files, const std::string& path) {
  Opened opened;
  Manifest manifest;
  std::shared_ptr<RecordingSource> source;
  if (KA_TRY(kind_of_file(files, path)) == FileKind::recording) {
    source = KA_TRY(RecordingSource::open(files, path, RecordingSource::Devices::learned));
    opened.facts = source->survey().facts;
    manifest = KA_TRY(manifest_of(source->survey(), std::string(file_name(path))));
  } else {
    manifest = KA_TRY(load_manifest(files, path));
  }
  opened.recording =
      KA_TRY(open_recording(files, manifest, std::string(folder(path)), {{}, 1, source}));
  return opened;
}

/// The time from the truth's UTC to the recording's. Each got UTC by one reading of the host's
/// clocks, and a slewed clock makes these readings differ.
Duration shift_of(const Opened& opened, const TrueRecording& truth) {
  if (!opened.facts || !truth.host) return {};
  const ClockPair& anchor = opened.facts->anchor;
  const std::int64_t recorded = to_ns(anchor.utc) - anchor.raw.time_since_epoch().count();
  return Duration{recorded - (truth.host->utc_ns - truth.host->raw_ns)};
}

std::string name_of(const std::string& stream, const std::string& node) {
  return node.empty() ? stream : stream + " " + node;
}

std::string row(const TimeJudgement& one) {
  std::string interval = "none";
  if (one.half_width_s) {
    interval = fmt::format("± {:.3f}, {} of {} outside", 1e3 * *one.half_width_s, one.outside,
                           one.certified);
  }
  return fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {} |\n", name_of(one.stream, one.node),
                     one.samples, 1e3 * one.median_s, 1e3 * one.most_s, 1e3 * one.worst_s,
                     interval);
}

std::string row(const ValueJudgement& one) {
  const auto text = [&](double value) {
    return one.node.empty() ? fmt::format("{:.2f} cm", 100.0 * value)
                            : fmt::format("{:.4f} rad/s", value);
  };
  const auto or_none = [&](const std::optional<double>& value) {
    return value ? text(*value) : std::string("–");
  };
  std::string more = "–";
  if (one.alone) more = fmt::format("{:+.1f} %", 100.0 * (one.after / *one.alone - 1.0));
  return fmt::format("| {} | {} | {} | {} | {} |\n", name_of(one.stream, one.node),
                     or_none(one.before), text(one.after), or_none(one.alone), more);
}

std::string tables(const JudgedRecording& judged) {
  std::string text =
      "| device | samples | time error: median, ms | 95 % | worst | certified |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const TimeJudgement& one : judged.times) text += row(one);
  text +=
      "\n| values, rms | before | in the take | noise alone | more than that |\n"
      "| --- | --- | --- | --- | --- |\n";
  for (const ValueJudgement& one : judged.values) text += row(one);
  return text;
}

Result<Motion> true_motion(FileSystem& files, const Names& names, const TrueRecording& truth) {
  const std::string path = std::string(folder(names.truth)) + truth.motion_file;
  const BvhFile bvh = KA_TRY(read_bvh(KA_TRY(read_whole(files, path, most_text)), path, {}));
  return motion_of(bvh.clip, {.smooth_s = 0.0});
}

/// An error in the recording's contents, which names no file: the recording's name is added.
Error of_recording(const Names& names, Error error) {
  if (error.file.empty()) error.file = names.recording;
  return error;
}

/// Prints nothing if anything fails.
Result<int> run(const Names& names) {
  PosixFiles files;
  const TrueRecording truth =
      KA_TRY(read_truth(KA_TRY(read_whole(files, names.truth, most_text)), names.truth));
  const Motion motion = KA_TRY(true_motion(files, names, truth));
  const Opened opened = KA_TRY(open(files, names.recording));
  const Take take = KA_TRY(read_take(files, names.take));
  const Duration shift = shift_of(opened, truth);
  JudgedRecording judged{truth, {}, {}};
  for (const RecordedStream& stream : opened.recording.streams) {
    auto times = judge_time(stream, truth, shift);
    if (!times) return Failure(of_recording(names, times.error()));
    judged.times.push_back(*std::move(times));
  }
  auto values = judge_values({take, opened.recording, truth, motion, shift});
  if (!values) return Failure(of_recording(names, values.error()));
  judged.values = *std::move(values);
  std::fputs((names.summary ? summary(judged) : tables(judged)).c_str(), stdout);
  return std::all_of(judged.times.begin(), judged.times.end(),
                     [](const TimeJudgement& one) { return one.outside == 0; })
             ? 0
             : 1;
}

}  // namespace

}  // namespace kinalign

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool summary = !words.empty() && words.front() == "--summary";
  if (summary) words.erase(words.begin());
  if (words.size() != 3) {
    std::fputs("usage: kinalign_truth_table [--summary] RECORDING TAKE TRUTH\n", stderr);
    return 2;
  }
  const auto done = kinalign::run({words[0], words[1], words[2], summary});
  if (done) return *done;
  std::fprintf(stderr, "%s\n", kinalign::to_string(done.error()).c_str());
  return 3;
}
