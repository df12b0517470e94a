// SPDX-License-Identifier: Apache-2.0
// The takes are read twice. The first pass finds the windows that are kept, because an NPZ states
// the sizes of its arrays at its beginning. The second pass writes these windows.
#include "kinalign/dataset/windows/windows.h"

#include "kinalign/core/find_named.h"
#include "kinalign/dataset/windows/window_arrays.h"
#include "kinalign/dataset/windows/window_rows.h"
#include "kinalign/formats/take/guarded.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The names of a take's streams. They come from its summary, so the take is not opened.
std::set<std::string> streams_of(const WindowTake& take) {
  std::set<std::string> out;
  for (const StreamSummary& stream : take.summary.streams) out.insert(stream.name);
  return out;
}

/// The first of these streams that a take lacks; empty if the take has all of them.
std::string lacking(const std::vector<std::string>& names, const WindowTake& take) {
  const auto there = streams_of(take);
  const auto lacks = std::find_if(names.begin(), names.end(),
                                  [&](const auto& name) { return !there.contains(name); });
  return lacks == names.end() ? "" : *lacks;
}

/// The streams that the user wants; if none are given, those that all takes have.
Result<std::vector<std::string>> chosen_streams(const WindowSource& source,
                                                const WindowOptions& options) {
  if (!options.streams.empty()) return options.streams;
  std::vector<std::string> out;
  for (const StreamSummary& stream : source.takes.front().summary.streams) {
    const bool everywhere =
        std::all_of(source.takes.begin(), source.takes.end(),
                    [&](const WindowTake& take) { return streams_of(take).contains(stream.name); });
    if (everywhere) out.push_back(stream.name);
  }
  if (!out.empty()) return out;
  return Failure(Error{"", 0, "a stream that all takes have, or --stream", "no such stream"});
}

/// Fails if the takes have different rates (by more than 0.5 %) and the option --rate is not given.
Result<void> check_rates(const WindowSource& source, const WindowOptions& options) {
  if (options.rate_hz > 0.0) return {};
  const double rate = source.takes.front().summary.rate_hz;
  for (const WindowTake& take : source.takes) {
    // Rates that were estimated from stamps differ slightly between takes.
    const double other = take.summary.rate_hz;
    constexpr double tolerance = 0.005;
    if (std::abs(other - rate) <= tolerance * rate) continue;
    return Failure(
        Error{"", 0, "takes with the same rate, or --rate HZ",
              fmt::format("{:g} Hz in {} and {:g} Hz in {}", rate,
                          to_string(source.takes.front().name), other, to_string(take.name))});
  }
  return {};
}

/// The data of both passes. The first pass stores the places of the kept windows in `takes_`. The
/// second pass reads these places and writes the windows. All windows share the memory of `raw_`
/// and `window_`.
class Job {
 public:
  Job(FileSystem& files, const WindowSource& source, const WindowOptions& options,
      const Progress& progress)
      : files_(files),
        source_(source),
        options_(options),
        progress_(progress),
        grid_{static_cast<std::uint64_t>(options.length), static_cast<std::uint64_t>(options.step),
              options.rate_hz} {
    // Each take is read twice.
    for (const WindowTake& take : source.takes) total_ += 2 * take.summary.frames;
  }

  Result<void> find(const std::vector<std::string>& names);
  Result<void> write(const NewFile& target);
  WindowsMade made;

 private:
  // Opens only the streams and arrays that windows have.
  Result<TakeReader> open(std::size_t take) const {
    return TakeReader::open(
        files_, path_of(source_.folder, source_.takes[take].name, TakeFile::take), parts_);
  }
  Result<void> set_streams(const std::vector<std::string>& names);
  std::string reasons() const;
  Result<WindowedTake> windowed(std::size_t take, TakeReader& reader);
  Result<bool> is_valid(TakeReader& reader, const WindowPlace& place,
                        const std::vector<std::size_t>& groups);
  Result<bool> find_in(std::size_t take, const std::vector<std::string>& names);
  Result<void> done_with(std::size_t take, std::uint64_t passes);

  FileSystem& files_;
  const WindowSource& source_;
  const WindowOptions& options_;
  const Progress& progress_;
  WindowGrid grid_;
  TakeParts parts_;
  WindowStreams streams_;
  std::vector<WindowedTake> takes_;
  TakeSlab raw_, window_;
  std::uint64_t done_ = 0, total_ = 0;
};

Result<void> Job::done_with(std::size_t take, std::uint64_t passes) {
  done_ += passes * source_.takes[take].summary.frames;
  return go_on(progress_, "windows", done_, total_) ? Result<void>() : Failure(interruption());
}

/// The groups with these names, in this order.
std::vector<TakeGroup> groups_of(const TakeHeader& header, const std::vector<std::string>& names) {
  std::vector<TakeGroup> out;
  for (const std::string& name : names) {
    if (const TakeGroup* found = find_named(header.groups, name)) out.push_back(*found);
  }
  return out;
}

/// Chooses the streams of the windows: those of the first take in the spaces that most takes have.
Result<void> Job::set_streams(const std::vector<std::string>& names) {
  struct Spaces {
    std::vector<TakeGroup> groups;  // from the first take with these spaces
    std::size_t takes = 0;
  };
  std::vector<Spaces> all;
  for (std::size_t take = 0; take < source_.takes.size(); ++take) {
    // Takes that lack a stream are not counted for the choice of spaces.
    if (!lacking(names, source_.takes[take]).empty()) continue;
    const TakeReader reader = KA_TRY(open(take));
    std::vector<TakeGroup> groups = groups_of(reader.header(), names);
    const auto same = [&](const Spaces& one) {
      // Only the spaces are compared, because data in different spaces must not be in one array.
      return std::equal(one.groups.begin(), one.groups.end(), groups.begin(), groups.end(),
                        [](const TakeGroup& a, const TakeGroup& b) { return a.space == b.space; });
    };
    const auto known = std::find_if(all.begin(), all.end(), same);
    if (known != all.end()) ++known->takes;
    if (known == all.end()) all.push_back({std::move(groups), 1});
  }
  // The spaces of most takes are chosen, so that as few takes as possible are left out.
  const auto most = std::max_element(
      all.begin(), all.end(), [](const Spaces& a, const Spaces& b) { return a.takes < b.takes; });
  if (most != all.end()) streams_.groups = std::move(most->groups);
  return {};
}

/// The reasons why takes were left out, as text: "has no stream imu (2 takes); ...".
std::string Job::reasons() const {
  std::map<std::string, std::size_t> counts;
  for (const TakeLeftOut& one : made.takes_left_out) ++counts[one.why];
  std::string out;
  for (const auto& [why, takes] : counts) {
    out +=
        fmt::format("{}{} ({} take{})", out.empty() ? "" : "; ", why, takes, takes == 1 ? "" : "s");
  }
  return out.empty() ? "none" : out;
}

/// Reads a window; true if each of its streams has enough valid cells.
Result<bool> Job::is_valid(TakeReader& reader, const WindowPlace& place,
                           const std::vector<std::size_t>& groups) {
  KA_TRY(read_window(reader, place, grid_, raw_, window_));
  return std::all_of(groups.begin(), groups.end(), [&](std::size_t group) {
    return valid_share(window_, group, place.rows) >= options_.valid;
  });
}

/// The windows of one take that have enough valid cells.
Result<WindowedTake> Job::windowed(std::size_t take, TakeReader& reader) {
  WindowedTake out{take, KA_TRY(streams_.find_in(reader.header())), {}, {}};
  for (const std::size_t group : out.groups) {
    const auto* clip = std::get_if<ClipGroup>(&reader.header().groups[group].kind);
    if (clip != nullptr) out.rest_offsets.push_back(clip->skeleton.rest_offsets);
  }
  const WindowPlaces found = place_windows(KA_TRY(reader.stamps()), grid_);
  // Rows in short stretches are counted and reported to the user.
  made.rows_left_out += found.rows_left_out;
  for (const WindowPlace& place : found.places) {
    // Without a limit for valid cells, windows need not be read in this pass.
    const bool kept = options_.valid <= 0.0 || KA_TRY(is_valid(reader, place, out.groups));
    if (kept) out.places.push_back(place);
    if (!kept) ++made.too_little_valid;
  }
  return out;
}

/// Finds the windows of one take. Returns false if it has none, and leaves it out.
Result<bool> Job::find_in(std::size_t take, const std::vector<std::string>& names) {
  const WindowTake& of = source_.takes[take];
  const auto leave_out = [&](std::string why) {
    made.takes_left_out.push_back({of.name, std::move(why)});
    return false;
  };
  if (const std::string lacks = lacking(names, of); !lacks.empty()) {
    return leave_out("has no stream " + lacks);
  }
  TakeReader reader = KA_TRY(open(take));
  // If a take has other joints or nodes than the first one, it is left out; this is no error.
  const auto fits = streams_.find_in(reader.header());
  if (!fits) return leave_out(fits.error().found);
  // The list of arrays is complete only after all takes were seen.
  streams_.add(reader.header(), *fits);
  WindowedTake found = KA_TRY(windowed(take, reader));
  made.windows[of.part] += found.places.size();
  if (found.places.empty()) return leave_out("has no window: too short, or too few valid cells");
  takes_.push_back(std::move(found));
  return true;
}

/// The first pass: finds the windows, and the takes that have none.
Result<void> Job::find(const std::vector<std::string>& names) {
  parts_ = {names, window_array_names()};
  made.windows.assign(source_.parts.size(), 0);
  KA_TRY(set_streams(names));
  for (std::size_t take = 0; take < source_.takes.size(); ++take) {
    // A take that was left out is not read in the second pass, so both of its passes are done.
    const bool is_kept = KA_TRY(find_in(take, names));
    KA_TRY(done_with(take, is_kept ? 1 : 2));
  }
  // If no window is found, the error states why the takes were left out.
  if (!takes_.empty()) return {};
  return Failure(Error{source_.folder, 0, "at least one window", reasons()});
}

/// The second pass: writes the windows.
Result<void> Job::write(const NewFile& target) {
  WindowFile file = KA_TRY(
      WindowFile::create(files_, target, window_layout(source_, options_, streams_, takes_)));
  for (std::size_t i = 0; i < takes_.size(); ++i) {
    const WindowedTake& take = takes_[i];
    TakeReader reader = KA_TRY(open(take.index));
    for (const WindowPlace& place : take.places) {
      KA_TRY(read_window(reader, place, grid_, raw_, window_));
      // The index `i` is that in the file's list of takes, which has only takes with windows.
      KA_TRY(file.append({i, source_.takes[take.index].part, place}, take.groups, window_));
    }
    KA_TRY(done_with(take.index, 1));
  }
  return file.finish();
}

/// The result of the child process as text.
std::string text_of(const WindowsMade& made) {
  Json out{{"windows", made.windows},
           {"rows", made.rows_left_out},
           {"invalid", made.too_little_valid},
           {"left_out", Json::array()}};
  for (const TakeLeftOut& one : made.takes_left_out) {
    out["left_out"].push_back({to_string(one.name), one.why});
  }
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Parses the text of text_of(), which the child process wrote.
WindowsMade made_from(const std::string& text) {
  const Json json = Json::parse(text);
  WindowsMade made{json.at("windows").get<std::vector<std::uint64_t>>(),
                   json.at("rows").get<std::uint64_t>(),
                   json.at("invalid").get<std::uint64_t>(),
                   {}};
  for (const Json& one : json.at("left_out")) {
    made.takes_left_out.push_back(
        {parse_take_name(one.at(0).get<std::string>()).value_or(TakeName{}), one.at(1)});
  }
  return made;
}

}  // namespace

Result<WindowsMade> write_windows(FileSystem& files, const WindowSource& source,
                                  const WindowOptions& options, const NewFile& target,
                                  const Progress& progress) {
  if (source.takes.empty()) return Failure(Error{source.folder, 0, "takes that are built", "none"});
  const auto names = KA_TRY(chosen_streams(source, options));
  KA_TRY(check_rates(source, options));
  GuardLimits limits;
  // The limits of the child process grow with the number of takes.
  limits.cpu_seconds += 60 * source.takes.size();
  limits.wall_seconds += 600.0 * static_cast<double>(source.takes.size());
  const Error blame{source.folder, 0, "takes that HDF5 can read", ""};
  const auto work = [&](const Progress& child_progress) -> Result<std::string> {
    // Both passes run in the same child process.
    Job job(files, source, options, child_progress);
    KA_TRY(job.find(names));
    KA_TRY(job.write(target));
    return text_of(job.made);
  };
  return made_from(KA_TRY(run_guarded(limits, blame, progress, work)));
}

}  // namespace kinalign
