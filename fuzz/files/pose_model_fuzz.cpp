// SPDX-License-Identifier: Apache-2.0
// A model for poses that is accepted is written and read again to the same bytes, and answers two
// frames.
#include "kinalign/models/pose/pose_model.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto first = read_pose_model({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!first) return 0;
  const std::string bytes = write_pose_model(*first);
  const auto second = read_pose_model(bytes, "again");
  if (!second || write_pose_model(*second) != bytes) std::abort();
  auto solver = PoseSolver::make(*std::move(first));
  if (!solver) return 0;
  const std::size_t nodes = solver->model().layout.nodes.size();
  const NodeFrames frames{nodes, std::vector<float>(8 * nodes, 0.5F),
                          std::vector<float>(6 * nodes, 0.5F), std::vector<float>(6 * nodes, 0.5F),
                          std::vector<std::uint8_t>(2 * nodes, 1)};
  const Clip clip = solver->clip(frames, Time{});
  if (clip.frames.size() != 2 || !validate(clip.skeleton)) std::abort();
  return 0;
}
