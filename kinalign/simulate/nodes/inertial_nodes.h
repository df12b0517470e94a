// SPDX-License-Identifier: Apache-2.0
// Inertial nodes worn on a moving body: the samples that their firmware would send, and the truth.
// A timer on the node's counter reads the registers of the sensor chip (firmware/node/sampler.cpp).
// The chip measures a thousand times per second of true time. The error of the chip's own
// oscillator is not simulated, because it acts as a scale error, which the percentages in
// inertial_sensor.h include.
//
// The orientation comes from a Mahony filter that gets the registers at the chip's rate. It
// therefore drifts and tilts as in a real node. Each filter has its own world: y up, and a heading
// of 0 at the start.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/streams.h"
#include "kinalign/simulate/nodes/inertial_sensor.h"
#include "kinalign/simulate/nodes/inertial_truth.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <vector>

namespace kinalign {

/// Returns the five nodes of the HFUT-MMD paper: waist, wrist_left, wrist_right, ankle_left,
/// ankle_right (on the shanks). Their positions on the bones are chosen, with random deviations of
/// some centimetres. A sensor's z points away from the body and its x along the bone, apart from a
/// random rotation of up to 15 degrees. The rest pose must be a T-pose that faces +z, palms down.
/// Fails if the skeleton lacks one of the joints Hips, LeftLeg, LeftFoot, LeftForeArm, LeftHand and
/// their right counterparts; skeletons of Perception Neuron and CMU have all of them.
Result<std::vector<Mounting>> five_nodes(const Skeleton& skeleton, std::uint64_t seed);

struct InertialNodeOptions {
  std::uint32_t rate_hz = 60;  // rate of samples, 1 to 1000; 15, 60 and 100 are usual
  bool orientation = true;     // the node sends orientations; the present firmware sends none
  double rest_s = 2.0;    // s at rest before the node was worn; the mean rate gives the filter's
                          // initial bias; 0: no bias
  double worn_s = 300.0;  // s from that rest to the beginning; the zero offsets drift during this
                          // time
  InertialSensorModel sensor{};
  MahonyOptions filter{};
  NodeClockOptions clock{};
};

struct SimulatedNodeSample {
  /// The node's counter at the sample. Ages of samples in a frame refer to it.
  std::uint64_t counter_us = 0;
  NodeSample sample;  // its age is 0 and is set by the frame that contains the sample
};

/// The truth at the time of each sample. The counter gives that time to the microsecond.
struct NodeTruth {
  std::vector<double> times;        // [N] s of the motion
  std::vector<SensorPlace> places;  // [N]
};

/// One node: how it is worn, the samples that it would send, and the truth.
struct SimulatedNode {
  Mounting mounting;
  std::uint64_t seed = 0;  // for its SimulatedClock and its link (simulate_exchanges)
  SensorErrors errors;     // at the end of the motion
  std::vector<SimulatedNodeSample> samples;
  NodeTruth truth;
};

/// Simulates all nodes in one pass over the motion. Fails if the rate is out of range, or if the
/// skeleton has no joint of a mounting.
Result<std::vector<SimulatedNode>> simulate_nodes(const Motion& motion,
                                                  const std::vector<Mounting>& mountings,
                                                  const InertialNodeOptions& options,
                                                  std::uint64_t seed);

/// Returns the samples of one node as in a file, stamped by its own counter. `start`: the time at
/// which the counter was 0.
ImuStream imu_stream(const SimulatedNode& node, Time start);

}  // namespace kinalign
