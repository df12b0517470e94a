// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/recording_words.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// Returns text about datagrams that the kernel dropped. At a nodes' port, the kernel's filter
/// drops foreign datagrams, and a full buffer drops frames. The number of lost frames tells how
/// many datagrams are certainly foreign.
std::string dropped_text(const PortCounts& counts, std::uint64_t frames_lost) {
  if (!counts.sifted) return "dropped by the kernel";
  const std::uint64_t least = foreign_datagrams(counts, frames_lost);
  if (least == counts.dropped) return "dropped: not frames of nodes";
  if (least == 0) return "dropped: not frames of nodes, or the buffer was full";
  return fmt::format("dropped, at least {} of them not frames of nodes", grouped(least));
}

}  // namespace

std::string sender_name(const std::string& stream, const std::string& node,
                        const std::string& place) {
  if (node.empty()) return stream;
  return stream + " " + (place.empty() ? node : place);
}

std::string sender_name(const std::string& stream, const std::string& node,
                        const RecordingSurvey& survey) {
  // The recording states the places under "stream/node".
  const auto place = survey.places.find(stream + "/" + node);
  return sender_name(stream, node, place == survey.places.end() ? "" : place->second);
}

std::string name_of(const CountedSender& sender, const RecordingSurvey& survey) {
  return sender_name(sender.stream, sender.node, survey) +
         (sender.sender.empty() ? "" : " from " + sender.sender);
}

std::string loss_of(const PortCounts& counts, std::uint64_t frames_lost) {
  return counts_in_words({{counts.dropped, dropped_text(counts, frames_lost)},
                          {counts.refused, "refused, not recorded"},
                          {counts.cut, "cut"},
                          {counts.unsent, "answers not sent"}});
}

std::string unusable_data(const PortCounts& counts, const std::string& to) {
  const std::uint64_t came = counts.dropped + counts.refused;
  // Only a nodes' port has a filter, so only this port counts foreign datagrams.
  if (!counts.sifted || came == 0) return "";
  return fmt::format(
      "{} datagrams came {}, {}", grouped(came), to,
      counts.refused == 0 ? "none of them a frame of nodes" : "none of them accepted");
}

}  // namespace kinalign
