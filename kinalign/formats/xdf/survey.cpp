// SPDX-License-Identifier: Apache-2.0
// Reads an XDF file once, and describes its streams and their faults.
#include "kinalign/core/numbers.h"
#include "kinalign/formats/xdf/xdf.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

/// Collects the results of one pass. Samples are counted and dropped, so the memory does not grow
/// with the file.
class Surveyor {
 public:
  void take(const XdfItem& item) {
    if (const auto* stream = std::get_if<XdfStream>(&item)) {
      places_[stream->id] = survey_.streams.size();
      survey_.streams.emplace_back().stream = *stream;
      // There is one element for each stream, in the order of the headers.
      last_.emplace_back();
    } else if (const auto* samples = std::get_if<XdfSamples>(&item)) {
      add(*samples);
    } else {
      const auto& offset = std::get<XdfClockOffset>(item);
      offsets_[offset.stream].push_back(offset);
    }
  }

  XdfSurvey finish() {
    for (XdfStreamSurvey& one : survey_.streams) {
      const std::vector<XdfClockOffset>& offsets = offsets_[one.stream.id];
      one.clock_offsets = offsets.size();
      // All offsets are needed before lines can be fitted.
      one.clock = fit_xdf_clock(offsets);
    }
    return std::move(survey_);
  }

 private:
  void add(const XdfSamples& samples) {
    // The reader passes on samples only after the header of their stream.
    const std::size_t place = places_.at(samples.stream);
    XdfStreamSurvey& one = survey_.streams[place];
    one.samples += samples.size();
    for (std::size_t t = 0; t < samples.size(); ++t) {
      one.deduced += samples.deduced[t];
      add_stamp(samples.stamps[t], one, last_[place]);
    }
    if (const auto* values = std::get_if<std::vector<double>>(&samples.values)) {
      one.no_numbers += static_cast<std::uint64_t>(std::count_if(
          values->begin(), values->end(), [](double v) { return !std::isfinite(v); }));
    }
  }

  /// Counts a stamp. A stamp that is not a number can't be the first or the last stamp.
  static void add_stamp(double stamp, XdfStreamSurvey& one, std::optional<double>& last) {
    if (!(std::abs(stamp) < largest_number)) {
      ++one.timeless;
      return;
    }
    // Stamps that are not numbers are skipped in this comparison.
    if (last && stamp < *last) {
      ++one.backward;
      one.largest_step_back_s = std::max(one.largest_step_back_s, *last - stamp);
    }
    last = stamp;
    // Stamps may fall, so `first` is the smallest stamp and `last` the largest.
    one.first = std::min(one.first.value_or(stamp), stamp);
    one.last = std::max(one.last.value_or(stamp), stamp);
  }

  XdfSurvey survey_;
  std::map<std::uint32_t, std::size_t> places_;  // stream id -> index in the survey
  std::vector<std::optional<double>> last_;      // last stamp of each stream
  std::map<std::uint32_t, std::vector<XdfClockOffset>> offsets_;
};

}  // namespace

Result<Findings> read_xdf(FileSystem& files, const std::string& path, const Progress& progress,
                          const std::function<Result<void>(const XdfItem&)>& take) {
  InputFile input = KA_TRY(InputFile::open(files, path));
  XdfReader reader(path);
  std::vector<XdfItem> items;
  std::uint64_t done = 0;
  // The empty piece at the end of the file leads to finish().
  for (bool ended = false; !ended;) {
    const std::string_view piece = KA_TRY(input.next());
    ended = piece.empty();
    items.clear();
    KA_TRY(ended ? reader.finish(items) : reader.feed(piece, items));
    for (const XdfItem& item : items) KA_TRY(take(item));
    done += piece.size();
    if (!go_on(progress, "reading", done, input.size())) return Failure(interruption(path));
  }
  return reader.findings();
}

double XdfStreamSurvey::rate_hz() const {
  const std::uint64_t stamped = samples - timeless;
  if (!first || stamped < 2 || !(*last > *first)) return 0.0;
  return static_cast<double>(stamped - 1) / (*last - *first);
}

/// Reads the whole file without storing the samples.
Result<XdfSurvey> survey_xdf(FileSystem& files, const std::string& path, const Progress& progress) {
  Surveyor surveyor;
  const Findings findings =
      KA_TRY(read_xdf(files, path, progress, [&surveyor](const XdfItem& item) -> Result<void> {
        surveyor.take(item);
        return {};
      }));
  XdfSurvey survey = surveyor.finish();
  // The current size of the file, for the listing.
  survey.bytes = KA_TRY(InputFile::open(files, path)).size();
  survey.findings = findings;
  return survey;
}

}  // namespace kinalign
