// SPDX-License-Identifier: Apache-2.0
// Inertial nodes worn on a moving body: the samples that their firmware would send, with the truth.
// A timer on the node's counter reads the registers (firmware/node/sampler.cpp). The chip behind
// them measures a thousand times a second of true time. Its own oscillator is assumed to be right:
// its error acts as a scale error of the rate, which is part of the percentages in
// inertial_sensor.h.
// The orientation comes from a Mahony filter at the chip's rate on the content of the registers, so
// it drifts and tilts as a real node's does. Each filter has its own world: y up, and a heading of
// 0 at the start.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/streams.h"
#include "kinalign/simulate/nodes/inertial_sensor.h"
#include "kinalign/simulate/nodes/inertial_truth.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <vector>

namespace kinalign {

/// The five nodes of the paper: waist, wrist_left, wrist_right, ankle_left, ankle_right (on the
/// shanks). Their positions on the bones are chosen, with some random centimetres. The
/// rest pose must be a T-pose that faces +z, palms down. A sensor's z points away from the body and
/// its x along the bone, apart from a random turn of up to 15 degrees. Fails if the skeleton lacks
/// one of the joints Hips, LeftLeg, LeftFoot, LeftForeArm, LeftHand and their right counterparts;
/// Perception Neuron and CMU have all of them.
Result<std::vector<Mounting>> five_nodes(const Skeleton& skeleton, std::uint64_t seed);

struct InertialNodeOptions {
  std::uint32_t rate_hz = 60;  // rate of samples, 1 to 1000; usual are 15, 60, 100
  bool orientation = true;     // true: the node sends it; the present firmware sends none
  double rest_s = 2.0;    // time that the node lay still before it was worn; its mean rate then is
                          // the filter's initial bias; 0: no initial bias
  double worn_s = 300.0;  // time from that rest to the beginning, in which its zeros walked on
  InertialSensorModel sensor{};
  MahonyOptions filter{};
  NodeClockOptions clock{};
};

struct SimulatedNodeSample {
  /// The node's counter at the sample. The ages of samples in a frame are counted from it.
  std::uint64_t counter_us = 0;
  NodeSample sample;  // with an age of 0; the frame that carries the sample sets it
};

/// The truth at the instants of the samples, which the counter gives to the microsecond.
/// One entry for each sample.
struct NodeTruth {
  std::vector<double> times;        // [N] s of the motion
  std::vector<SensorPlace> places;  // [N]
};

/// Everything about one node: how it is worn, what it would send, and what is true.
struct SimulatedNode {
  Mounting mounting;
  std::uint64_t seed = 0;  // for its SimulatedClock and its link (simulate_exchanges)
  SensorErrors errors;     // at the end of the motion
  std::vector<SimulatedNodeSample> samples;
  NodeTruth truth;
};

/// Simulates all nodes in one pass over the motion. Fails if the rate is not within its range, or
/// if a mounting names no joint of the skeleton.
Result<std::vector<SimulatedNode>> simulate_nodes(const Motion& motion,
                                                  const std::vector<Mounting>& mountings,
                                                  const InertialNodeOptions& options,
                                                  std::uint64_t seed);

/// The samples of one node as in a file, stamped by its own counter. `start`: the time at which the
/// counter stood at 0.
ImuStream imu_stream(const SimulatedNode& node, Time start);

}  // namespace kinalign
