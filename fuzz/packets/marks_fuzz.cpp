// SPDX-License-Identifier: Apache-2.0
// Calls and broadcasts for marks. An accepted call is written and read again to the same, and so is
// a mark of a recording. An answer is never longer than the call that it answers.
#include "fuzz/pieces.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/protocols/marks/vicon_trigger.h"
#include "kinalign/recording/format.h"

using namespace kinalign;

namespace {

void check_recorded(std::string_view text) {
  const auto recorded = to_mark(text);
  if (!recorded) return;
  const auto again = to_mark(to_json(*recorded));
  if (!again || !(again->mark == recorded->mark)) std::abort();
}

void check_call(std::string_view text) {
  Mark mark, again;
  const MarkCallRefusal refusal = decode_mark_call(text, mark);
  if (answer_to_refused_call(mark, refusal, text.size()).size() > text.size()) std::abort();
  if (refusal != MarkCallRefusal::none) {
    mark.id.clear();
    if (!(mark == Mark{})) std::abort();
    return;
  }
  const std::string written = encode_mark_call(mark);
  if (written.size() <= most_mark_call &&
      (decode_mark_call(written, again) != MarkCallRefusal::none || !(again == mark))) {
    std::abort();
  }
  if (answer_to_mark_call(mark, MarkAnswer::repeat, text.size()).size() > text.size()) {
    std::abort();
  }
}

void check_broadcast(std::string_view text) {
  ViconTrigger trigger;
  if (decode_vicon_trigger(text, trigger) != ViconRefusal::none) {
    if (!(trigger == ViconTrigger{})) std::abort();
    return;
  }
  if (!is_mark_text(mark_of(trigger).text)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_recorded(text_of(data, size));
  check_call(text_of(data, size));
  check_broadcast(text_of(data, size));
  return 0;
}
