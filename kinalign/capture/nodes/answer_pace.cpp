// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/answer_pace.h"

#include <cmath>

namespace kinalign {

// Once a second, the stride is computed from the rate of the previous second.
bool AnswerPace::ask(HostTime now) {
  constexpr Duration second = std::chrono::seconds(1);
  if (begin_ == HostTime::min() || now < begin_) begin_ = now;
  if (now - begin_ >= second) {
    rate_hz_ = static_cast<double>(frames_) / seconds(now - begin_);
    // allows for a second that contains one frame more because of timing jitter
    stride_ = static_cast<std::int64_t>(std::ceil((*rate_hz_ - 1.5) / most_per_s));
    if (stride_ < 1) stride_ = 1;
    begin_ = now;
    frames_ = answers_ = 0;
  }
  const bool answer = frames_++ % stride_ == 0 && answers_ < most_per_s;
  if (answer) ++answers_;
  return answer;
}

}  // namespace kinalign
