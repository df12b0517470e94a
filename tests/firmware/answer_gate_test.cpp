// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/answer_gate.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr std::uint32_t node = 7, boot = 0x5eedf00d;

/// A gate that has issued `sent` frame numbers, the last of them `last`.
AnswerGate gate(std::uint32_t sent, std::uint32_t last) {
  AnswerGate made({node, boot, last - sent + 1});
  for (std::uint32_t i = 0; i < sent; ++i) CHECK(made.issue().sequence == last - sent + 1 + i);
  return made;
}

}  // namespace

TEST_CASE("an answer counts once, and each frame may have one") {
  AnswerGate three = gate(3, 2);
  CHECK(three.admit({node, boot, 0}));
  CHECK(!three.admit({node, boot, 0}));
  CHECK(three.admit({node, boot, 2}));
  CHECK(!three.admit({node, boot, 1}));  // late: a later frame has been answered
  CHECK(three.counts().accepted == 2);
  CHECK(three.counts().not_newer == 2);
}

TEST_CASE("an answer to another node or another start is ignored") {
  AnswerGate three = gate(3, 2);
  CHECK(!three.admit({node + 1, boot, 2}));
  CHECK(!three.admit({node, boot - 1, 2}));
  CHECK(three.counts().other_node == 1);
  CHECK(three.counts().other_boot == 1);
  CHECK(three.admit({node, boot, 2}));
}

TEST_CASE("an answer to a frame that was not sent, or long ago, is ignored") {
  AnswerGate fresh({node, boot, 0});
  CHECK(!fresh.admit({node, boot, 0}));
  CHECK(!fresh.admit({node, boot, UINT32_MAX}));
  AnswerGate three = gate(3, 2);
  CHECK(!three.admit({node, boot, 3}));
  CHECK(!three.admit({node, boot, UINT32_MAX}));  // the number before the first
  AnswerGate long_run = gate(1000, 999);
  CHECK(!long_run.admit({node, boot, 999 - AnswerGate::window}));
  CHECK(long_run.admit({node, boot, 1000 - AnswerGate::window}));
  CHECK(fresh.counts().unknown_frame == 2);
  CHECK(three.counts().unknown_frame == 2);
  CHECK(long_run.counts().unknown_frame == 1);
}

TEST_CASE("frame numbers wrap") {
  AnswerGate wrapped = gate(10, 4);  // numbers 0xfffffffb to 4
  CHECK(wrapped.admit({node, boot, 0xfffffffe}));
  CHECK(!wrapped.admit({node, boot, 0xfffffffd}));
  CHECK(wrapped.admit({node, boot, 3}));
  CHECK(!wrapped.admit({node, boot, 0xffffffff}));
  CHECK(!wrapped.admit({node, boot, 5}));
  CHECK(wrapped.counts().accepted == 2);
  CHECK(wrapped.counts().not_newer == 2);
  CHECK(wrapped.counts().unknown_frame == 1);
}

TEST_CASE("an old answer is known as old however many frames follow it, until it is forgotten") {
  AnswerGate run = gate(5, 4);
  CHECK(run.admit({node, boot, 4}));
  for (int i = 0; i < 63; ++i) {
    CHECK(run.issue().sequence == 5U + static_cast<std::uint32_t>(i));
    CHECK(!run.admit({node, boot, 4}));
  }
  CHECK(run.counts().not_newer == 63);
  CHECK(run.issue().sequence == 68);
  CHECK(!run.admit({node, boot, 4}));
  CHECK(run.counts().unknown_frame == 1);
}
