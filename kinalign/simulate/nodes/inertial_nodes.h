// SPDX-License-Identifier: Apache-2.0
// Inertial nodes worn on a moving body: what their firmware would send, with the truth beside it.
// A timer on the node's counter reads the registers (firmware/node/sampler.cpp); the chip behind
// them measures a thousand times a second of true time (its own oscillator is taken to be right:
// what it is off acts as a scale error of the rate, and is one of inertial_sensor.h's percent).
// Orientation is a Mahony filter at the chip's rate over what the registers held, so that it drifts
// and tilts as a node's would. Each filter's world is its own: y up, and a heading that is 0 at the
// start.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/streams.h"
#include "kinalign/simulate/nodes/inertial_sensor.h"
#include "kinalign/simulate/nodes/inertial_truth.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <vector>

namespace kinalign {

/// The five of the paper: waist, wrist_left, wrist_right, ankle_left, ankle_right (on the shanks).
/// Where on the bone: models.md 4.4, some cm drawn, for a body whose rest pose is a T-pose that
/// faces +z, palms down. z of a sensor points away from the body and x along the bone, but for a
/// drawn turn of up to 15 degrees. Fails where the skeleton lacks one of the joints Hips, LeftLeg,
/// LeftFoot, LeftForeArm, LeftHand and their right ones (Perception Neuron and CMU have them).
Result<std::vector<Mounting>> five_nodes(const Skeleton& skeleton, std::uint64_t seed);

struct InertialNodeOptions {
  std::uint32_t rate_hz = 60;  // of samples, 1 to 1000: 15, 60, 100 are usual
  bool orientation = true;     // is sent; a node with the firmware as it is sends none
  double rest_s = 2.0;    // it lay still before it was worn; its mean rate then is the bias that
                          // its filter starts with; 0: it starts with none
  double worn_s = 300.0;  // between that rest and the beginning: its zeros have walked on
  InertialSensorModel sensor{};
  MahonyOptions filter{};
  NodeClockOptions clock{};
};

struct SimulatedNodeSample {
  std::uint64_t counter_us =
      0;              // of the node when it was taken: what a frame's age is counted from
  NodeSample sample;  // its age is 0: the frame that carries it knows
};

/// At the instants that the counter's readings name, to the microsecond they are told in.
struct NodeTruth {
  std::vector<double> times;        // [N] s, of the motion
  std::vector<SensorPlace> places;  // [N]
};

struct SimulatedNode {
  Mounting mounting;
  std::uint64_t seed = 0;  // of its SimulatedClock, and for its link (simulate_exchanges)
  SensorErrors errors;     // at the end
  std::vector<SimulatedNodeSample> samples;
  NodeTruth truth;
};

/// One pass over the motion for all nodes. Fails where the rate is not within its range or a
/// mounting names no joint of the skeleton.
Result<std::vector<SimulatedNode>> simulate_nodes(const Motion& motion,
                                                  const std::vector<Mounting>& mountings,
                                                  const InertialNodeOptions& options,
                                                  std::uint64_t seed);

/// A file's worth of one node, stamped by its own counter: `start` is when that stood at 0.
ImuStream imu_stream(const SimulatedNode& node, Time start);

}  // namespace kinalign
