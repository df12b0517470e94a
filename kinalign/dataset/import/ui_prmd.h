// SPDX-License-Identifier: Apache-2.0
// Imports UI-PRMD: ten movements of rehabilitation, recorded with a Kinect v2 and Vicon markers and
// cut into repetitions. The data of each device were cut by hand separately, so the time shift
// between the two devices is not known.
#pragma once

#include "kinalign/dataset/import/corpus.h"

#include <map>
#include <string>

namespace kinalign {

/// The parts of a name "m01_s02_e03_positions.txt"; "_inc" marks a repetition that was done wrongly
/// on purpose.
struct PieceName {
  std::uint32_t movement = 0, subject = 0, repetition = 0;
  bool incorrect = false;

  auto operator<=>(const PieceName&) const = default;
  std::string action() const;  // "m01", "m01inc"
  std::string person() const;  // "02"
  std::string text() const;    // "m01_s02_e03"
};

/// The files of one repetition. Each path is empty until the device's file is found.
struct PiecePair {
  std::string kinect, vicon;  // files of positions; empty: none
  double vicon_hz = 100.0;
};
/// All pairs, sorted by movement, person and repetition.
using PiecePairs = std::map<PieceName, PiecePair>;

/// Finds the pairs of text files and of packs. Packs are unpacked below the raw folder.
Result<PiecePairs> find_ui_prmd_pairs(const ImportInput& input);

/// The streams of one pair: `kinect`, and the markers as `mocap`.
StreamOptions kinect_stream_of(const PiecePair& pair);
StreamOptions marker_stream_of(const PiecePair& pair);

/// The name, terms and actions of the corpus, without its takes.
Corpus ui_prmd_without_takes();

/// Removes pairs with only one device from `pairs` and notes them as left out.
void leave_out_single(PiecePairs& pairs, Corpus& corpus);

}  // namespace kinalign
