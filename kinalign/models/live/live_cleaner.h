// SPDX-License-Identifier: Apache-2.0
// Runs a model that cleans skeletons on live frames. Each frame is returned after a fixed delay,
// and the network runs over a window of the newest frames. Bone lengths are the medians of the last
// ten seconds.
#pragma once

#include "kinalign/infer/window_network.h"
#include "kinalign/models/denoise_model.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace kinalign {

/// The caller passes the frames, resampled to the model's rate, to step() in order. After the last
/// frame the caller calls finish() until it returns no joints.
class LiveCleaner {
 public:
  /// Bone lengths are medians over this many frames: 10 s at 30 Hz.
  static constexpr std::size_t remembered_lengths = 300;

  /// `denoiser` must outlive this object. `look_ahead`: the delay of an answer in frames. It is
  /// reduced to the number of later frames that network and smoothing use.
  LiveCleaner(Denoiser& denoiser, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }

  /// Takes the next frame of the layout's input joints. Returns the joints [Jout,3] m of the frame
  /// look_ahead() frames earlier; empty if there is no such frame yet.
  std::optional<std::vector<float>> step(const JointFrames& frame);
  /// Call when no further frames come: returns the next remaining frame; empty if none remains.
  std::optional<std::vector<float>> finish();

  /// All answers [T,Jout,3] m for a file: each bone has one length over the whole recording.
  std::vector<float> whole() const;

 private:
  /// The features of the window. The network runs again only for rows that have changed.
  struct Seen {
    WindowNetwork network;
    std::vector<float> rows{};  // [window, channels], from the previous run
  };

  std::vector<float> positions_of(Seen& seen, DenoiseFeatures features, std::size_t first,
                                  std::size_t end);
  std::vector<float> steadied_at(std::size_t row);
  std::vector<float> joints_at(std::size_t row);
  void forget_first();

  Denoiser* denoiser_;
  /// Number of later and of earlier frames in the window, seen from the answered frame.
  std::size_t ahead_, behind_;
  std::vector<std::size_t> inputs_, outputs_;  // each joint's partner on the other side
  JointFrames window_;  // begins with the same frame as the rows of plain_ and mirrored_
  Seen plain_, mirrored_;
  std::size_t next_ = 0;        // the row of the window that is answered next
  std::vector<float> answers_;  // all joints so far, before bones get constant lengths
};

}  // namespace kinalign
