// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/arrivals_of.h"

#include "kinalign/align/plan.h"
#include "kinalign/resample/window.h"

namespace kinalign {

Result<Arrivals> arrivals_of(const RecordedStream& stream, const StreamOptions& options, Role role,
                             const Progress& progress) {
  return std::visit(
      [&](const auto& input) -> Result<Arrivals> {
        constexpr std::size_t at_once = 4096;
        Window window(KA_TRY(input.passes()), stream.clock, {}, taken_step(stream, options, role));
        std::uint64_t rows = 0;
        for (std::int64_t from = INT64_MIN;; from = window.time_ns.back() + 1) {
          KA_TRY(window.fill(from, at_once));
          if (window.time_ns.empty()) return window.counts().arrivals;
          rows += window.time_ns.size();
          if (!go_on(progress, "checking", rows, stream.survey.samples)) {
            return Failure(interruption());
          }
        }
      },
      stream.data);
}

}  // namespace kinalign
