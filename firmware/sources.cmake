# SPDX-License-Identifier: Apache-2.0
# Sources of every node, whatever the board, from the repository's root.
set(KINALIGN_NODE_SOURCES
  firmware/node/answer_gate.cpp firmware/node/clockless_node.cpp firmware/node/frame_pace.cpp
  firmware/node/lights.cpp firmware/node/link_policy.cpp firmware/node/node.cpp
  firmware/node/sample_ring.cpp firmware/node/sampler.cpp)
set(KINALIGN_WIRE_SOURCES  # for builds that have no room
  kinalign/wire/clockless.cpp kinalign/wire/crc32.cpp kinalign/wire/node_datagram.cpp
  kinalign/wire/node_frame.cpp kinalign/wire/node_reply.cpp kinalign/wire/node_sample.cpp
  kinalign/wire/siphash.cpp)
set(KINALIGN_SCRIPT_SOURCES
  firmware/script/line.cpp firmware/script/script.cpp firmware/script/script_board.cpp)
