// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/arrivals_of.h"

#include <memory>

namespace kinalign {

namespace {

/// Returns a function that reads one stream block by block. The window measures the arrivals while
/// it reads, and stores only the samples of one block. Copies of the function share one window, so
/// each copy continues where another copy stopped.
template <class Frames>
ReadNext reading(Pass<Frames> pass, const RecordedStream& stream, const TakenStep& step,
                 Arrivals& out, std::uint64_t& rows) {
  auto window = std::make_shared<Window<Frames>>(std::move(pass), stream.clock, GapCount{}, step);
  return [window, &out, &rows, from = INT64_MIN]() mutable -> Result<std::optional<std::int64_t>> {
    constexpr std::size_t at_once = 1024;
    KA_TRY(window->fill(from, at_once));
    if (window->time_ns.empty()) {
      out = window->counts().arrivals;
      return std::optional<std::int64_t>();
    }
    rows += window->time_ns.size();
    // The next call asks for samples after this one, so the window drops the counted samples.
    from = window->time_ns.back() + 1;
    return std::optional(window->time_ns.back());
  };
}

}  // namespace

Result<std::vector<Arrivals>> arrivals_of(
    const std::vector<RecordedStream>& streams,
    const std::function<TakenStep(const RecordedStream&)>& step_of, const Progress& progress) {
  std::vector<Arrivals> arrivals(streams.size());
  std::vector<ReadNext> passes;
  std::uint64_t rows = 0, all = 0;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    all += streams[i].survey.samples;
    KA_TRY(std::visit(
        [&](const auto& input) -> Result<void> {
          passes.push_back(
              reading(KA_TRY(input.passes()), streams[i], step_of(streams[i]), arrivals[i], rows));
          return {};
        },
        streams[i].data));
  }
  // The streams are read in parallel, so that streams of one recording decode each of its chunks
  // once.
  KA_TRY(read_side_by_side(passes, [&]() -> Result<void> {
    if (go_on(progress, "checking", rows, all)) return {};
    return Failure(interruption());
  }));
  return arrivals;
}

}  // namespace kinalign
