// SPDX-License-Identifier: Apache-2.0
// A model that cleans skeletons frame by frame, some frames late: it runs over a window of the
// newest frames. Bones have the lengths that they had in the last ten seconds.
#pragma once

#include "kinalign/infer/window_network.h"
#include "kinalign/models/denoise_model.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace kinalign {

class LiveCleaner {
 public:
  static constexpr std::size_t remembered_lengths = 300;  // frames

  /// `denoiser` must live longer. `look_ahead`: frames that an answer waits for; more than network
  /// and smoothing see are not waited for.
  LiveCleaner(Denoiser& denoiser, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }

  /// Takes the next frame of the layout's inputs. The joints [Jout,3] m of the frame look_ahead()
  /// earlier; absent before there is one.
  std::optional<std::vector<float>> step(const JointFrames& frame);
  /// No further frames come: the next of those that are left.
  std::optional<std::vector<float>> finish();

  /// All answers [T,Jout,3] m as a file has them: each bone has one length over the whole.
  std::vector<float> whole() const;

 private:
  /// The window as a network sees it, which is run again only where it has changed.
  struct Seen {
    WindowNetwork network;
    std::vector<float> rows{};  // [window, channels] of the run before
  };

  std::vector<float> positions_of(Seen& seen, DenoiseFeatures features, std::size_t first,
                                  std::size_t end);
  std::vector<float> steadied_at(std::size_t row);
  std::vector<float> joints_at(std::size_t row);
  void forget_first();

  Denoiser* denoiser_;
  std::size_t ahead_, behind_;  // frames of the window on both sides of the one that is answered
  std::vector<std::size_t> inputs_, outputs_;  // each joint's partner on the other side
  JointFrames window_;
  Seen plain_, mirrored_;
  std::size_t next_ = 0;        // row of the window that is answered next
  std::vector<float> answers_;  // of all frames, with bones of any length
};

}  // namespace kinalign
