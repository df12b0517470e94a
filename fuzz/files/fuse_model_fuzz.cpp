// SPDX-License-Identifier: Apache-2.0
// A model for fusion that is accepted is written and read again to the same bytes, and answers two
// frames.
#include "kinalign/models/fuse/fuse_model.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto first = read_fuse_model({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!first) return 0;
  const std::string bytes = write_fuse_model(*first);
  const auto second = read_fuse_model(bytes, "again");
  if (!second || write_fuse_model(*second) != bytes) std::abort();
  auto fuser = Fuser::make(*std::move(first));
  if (!fuser) return 0;
  const std::size_t nodes = fuser->model().layout.nodes.nodes.size();
  const std::size_t joints = fuser->model().layout.joints.size();
  const FuseInput input{
      {nodes, std::vector<float>(8 * nodes, 0.5F), std::vector<float>(6 * nodes, 0.5F),
       std::vector<float>(6 * nodes, 0.5F), std::vector<std::uint8_t>(2 * nodes, 1)},
      {joints, std::vector<float>(6 * joints, 0.5F), std::vector<std::uint8_t>(2 * joints, 2)}};
  const Clip clip = fuser->clip(input, Time{});
  if (clip.frames.size() != 2 || !validate(clip.skeleton)) std::abort();
  return 0;
}
