// SPDX-License-Identifier: Apache-2.0
// UI-PRMD: a Kinect v2 and Vicon markers of ten movements of rehabilitation, cut into repetitions.
// Each device was cut by hand for itself, so that the time shift of a pair is not known.
#pragma once

#include "kinalign/dataset/import/corpus.h"

#include <map>
#include <string>

namespace kinalign {

/// "m01_s02_e03_positions.txt", and with _inc a repetition that was done wrongly on purpose.
struct PieceName {
  int movement = 0, subject = 0, repetition = 0;
  bool incorrect = false;

  auto operator<=>(const PieceName&) const = default;
  std::string action() const;  // "m01", "m01inc"
  std::string person() const;  // "02"
  std::string text() const;    // "m01_s02_e03"
};

struct PiecePair {
  std::string kinect, vicon;  // files of positions; empty where there is none
  double vicon_hz = 100.0;
};
using PiecePairs = std::map<PieceName, PiecePair>;

bool looks_like_ui_prmd(const std::vector<SourceFile>& sources);

/// The pairs of texts and of packs, which are unpacked below the raw folder.
Result<PiecePairs> find_ui_prmd_pairs(const ImportInput& input);

/// The streams `kinect` and `mocap`, the markers, of one pair.
StreamOptions kinect_stream_of(const PiecePair& pair);
StreamOptions marker_stream_of(const PiecePair& pair);

/// The corpus without its takes.
Corpus ui_prmd_without_takes();

/// Moves pairs that lack a device out of `pairs`, into the parts left out.
void leave_out_single(PiecePairs& pairs, Corpus& corpus);

}  // namespace kinalign
