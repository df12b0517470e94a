// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/answer_watch.h"

namespace kinalign {

std::string AnswerWatch::complaint(std::int64_t silent_ns, bool answers_came) const {
  if (answers_came) {
    return "answers of " + server_ + " are refused: they are not signed with the key in --key-file";
  }
  const std::string silent = std::to_string(silent_ns / 1'000'000'000);
  return server_ + " has not answered for " + silent +
         " s: either no kinalign time-server --node-port is there, or " +
         (keyed_ ? "its --lab-key is not the one that this node's key was made from, or is missing"
                 : "it has a --lab-key, so this node needs --key-file");
}

std::string AnswerWatch::look(std::int64_t age_ns, std::uint64_t accepted,
                              std::uint64_t wrong_key) {
  if (accepted > accepted_) {
    std::string better = complained_ ? server_ + " answers now" : "";
    complained_ = false;
    accepted_ = accepted;
    wrong_key_ = wrong_key;
    answered_ns_ = age_ns;
    next_ns_ = age_ns + first_ns;
    return better;
  }
  if (age_ns < next_ns_) return "";
  complained_ = true;
  next_ns_ = age_ns + every_ns;
  return complaint(age_ns - answered_ns_, wrong_key > wrong_key_);
}

}  // namespace kinalign
