// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/mark_call.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using Refusal = MarkCallRefusal;

Mark read(const std::string& call) {
  Mark mark;
  REQUIRE(decode_mark_call(call, mark) == Refusal::none);
  return mark;
}

Refusal refusal_of(const std::string& call) {
  Mark mark;
  const Refusal refusal = decode_mark_call(call, mark);
  if (refusal != Refusal::none) CHECK(mark == Mark{Mark::Kind::text, "", {}, mark.id});
  return refusal;
}

/// A call that is right but for `rest`.
std::string call(const std::string& rest) {
  return R"({"schema":"kinalign.mark/1","kind":"start","id":"7")" + rest + '}';
}

/// The n-th block of JSON in the page.
std::string of_page(int n) {
  const std::string page = bytes_in(KINALIGN_SOURCE_DIR "/docs/formats/marks.md");
  std::size_t at = 0;
  for (int i = 0; i <= n; ++i) at = page.find("```json\n", at) + 8;
  return page.substr(at, page.find('\n', at) - at);
}

}  // namespace

TEST_CASE("the page's call is what we read and send, its answer what we answer") {
  const std::string text = of_page(0);
  const Mark mark = read(text);
  CHECK(mark == Mark{Mark::Kind::start, "S1A02", 12'500'000ns, "b3f1-1"});
  CHECK(read(encode_mark_call(mark)) == mark);
  CHECK(answer_to_mark_call(mark, MarkAnswer::fresh, text.size()) == of_page(1));
  CHECK(answer_to_mark_call(mark, MarkAnswer::repeat, text.size()) ==
        R"({"mark":"b3f1-1","is":"repeat"})");
}

TEST_CASE("an answer is never longer than its call") {
  const Mark mark{Mark::Kind::stop, "", {}, std::string(64, '"')};
  const std::string text = encode_mark_call(mark);
  const std::string answer = answer_to_mark_call(mark, MarkAnswer::repeat, text.size());
  CHECK(!answer.empty());
  CHECK(answer.size() <= text.size());
  CHECK(answer_to_mark_call(mark, MarkAnswer::repeat, answer.size()) == answer);
  CHECK(answer_to_mark_call(mark, MarkAnswer::repeat, answer.size() - 1).empty());
}

TEST_CASE("a call that is refused is answered with the cause, and its id as far as it has one") {
  const auto answer = [](const std::string& text) {
    Mark mark;
    const Refusal refusal = decode_mark_call(text, mark);
    REQUIRE(refusal != Refusal::none);
    std::string said = answer_to_refused_call(mark, refusal, text.size());
    CHECK(said.size() <= text.size());
    if (!said.empty()) CHECK(answer_to_refused_call(mark, refusal, said.size() - 1).empty());
    return said;
  };
  CHECK(answer(of_page(2)) == of_page(3));
  CHECK(answer(R"({"schema":"kinalign.mark/1","id":"7"})") == R"({"mark":"7","is":"wrong_kind"})");
  CHECK(answer(R"({"schema":"kinalign.mark/1","kind":"stop"})") == R"({"is":"wrong_id"})");
  CHECK(answer(call(R"(,"latency_ms":-1)")) == R"({"mark":"7","is":"wrong_latency"})");
  CHECK(answer(call(R"(,"text":5)")) == R"({"mark":"7","is":"wrong_text"})");
}

TEST_CASE("what is no call of ours has no answer: two ports would answer each other for ever") {
  const auto answer = [](const std::string& text) {
    Mark mark;
    const Refusal refusal = decode_mark_call(text, mark);
    return answer_to_refused_call(mark, refusal, 1200);
  };
  for (const std::string text : {"", "no mark", "{}", R"({"mark":"b3f1-1","is":"new"})",
                                 R"({"mark":"7","is":"wrong_kind"})", R"({"is":"wrong_id"})"}) {
    CAPTURE(text);
    CHECK(answer(text).empty());
  }
  CHECK(answer(std::string(1201, ' ')).empty());
  CHECK(answer(call("")).empty());  // no call is refused
}

TEST_CASE("a call may say little, and more than we know") {
  const Mark pose =
      read(R"( {"id": "x", "more": {}, "kind": "t_pose", "schema": "kinalign.mark/1"} )");
  CHECK(pose == Mark{Mark::Kind::t_pose, "", {}, "x"});
  const Mark text =
      read(R"({"schema":"kinalign.mark/1","kind":"text","id":"x","text":"l\u00e4uft"})");
  CHECK(text.text == "l\xc3\xa4uft");
  CHECK(read(call(R"(,"latency_ms":0)")).latency == 0ns);
  CHECK(read(call(R"(,"latency_ms":60000)")).latency == 60s);
  CHECK(!read(call("")).latency);
}

TEST_CASE("each fault of a call has its name") {
  CHECK(refusal_of("") == Refusal::bad_json);
  CHECK(refusal_of("[1]") == Refusal::bad_json);
  CHECK(refusal_of(call("") + "x") == Refusal::bad_json);
  CHECK(refusal_of(std::string(1201, ' ')) == Refusal::too_long);
  CHECK(refusal_of(call("").insert(24, "1")) == Refusal::wrong_schema);
  CHECK(refusal_of("{}") == Refusal::wrong_schema);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"pause","id":"7"})") ==
        Refusal::wrong_kind);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","id":"7"})") == Refusal::wrong_kind);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"stop"})") == Refusal::wrong_id);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"stop","id":7})") == Refusal::wrong_id);
  const auto with_id = [](const std::string& id) {
    return refusal_of(R"({"schema":"kinalign.mark/1","kind":"stop","id":")" + id + "\"}");
  };
  CHECK(with_id("") == Refusal::wrong_id);
  CHECK(with_id(std::string(64, 'a')) == Refusal::none);
  CHECK(with_id(std::string(65, 'a')) == Refusal::wrong_id);
  CHECK(with_id("\xc3\xa4") == Refusal::wrong_id);
  for (const char* latency : {"-1", "60000.1", "\"5\"", "null"}) {
    CHECK(refusal_of(call(std::string(",\"latency_ms\":") + latency)) == Refusal::wrong_latency);
  }
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"t_pose","id":"7","latency_ms":5})") ==
        Refusal::wrong_latency);
  CHECK(refusal_of(call(R"(,"text":5)")) == Refusal::wrong_text);
  CHECK(refusal_of(call(",\"text\":\"" + std::string(500, 'a') + '"')) == Refusal::none);
  CHECK(refusal_of(call(",\"text\":\"" + std::string(501, 'a') + '"')) == Refusal::wrong_text);
  CHECK(refusal_of(call(R"(,"text":"\u001b[2J")")) == Refusal::wrong_text);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"text","id":"7"})") ==
        Refusal::wrong_text);
  CHECK(refusal_of(R"({"schema":"kinalign.mark/1","kind":"text","id":"7","text":""})") ==
        Refusal::wrong_text);
  CHECK(std::string(name_of(Refusal::wrong_text)) == "wrong_text");
}
