// SPDX-License-Identifier: Apache-2.0
// Channels of a tracking system: the rows of channels.tsv, one for each column of motion.tsv.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/formats/bids/tsv_table.h"
#include "kinalign/formats/reader.h"
#include "kinalign/motion/clip.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

struct BidsChannel {
  std::string name, component, type, tracked_point, units, placement, reference_frame;
};

/// What the channels of a stream are made from.
using BidsSource = std::variant<Skeleton, PointHeader, ImuHeader>;

/// A column LATENCY, then of a skeleton's joints POS and ORNT, of points POS, of nodes ORNT, ACCEL
/// and GYRO as far as there are any. Places and orientations stand in the frame "global",
/// accelerations and angular velocities in the frame "sensor".
std::vector<BidsChannel> bids_channels(const BidsSource& source);

TsvTable channels_table(std::span<const BidsChannel> channels);
/// Fails where one of the first five columns is missing; `file` appears in messages.
Result<std::vector<BidsChannel>> channels_of(const TsvTable& table, std::string_view file);

/// The types of BIDS 1.9, in capitals.
bool is_bids_type(std::string_view type);
bool is_bids_component(std::string_view component);
/// Metres, radians, m/s2, ... of one unit; 0: it is none of the type's.
double unit_scale(std::string_view type, std::string_view unit);

/// Ours from a space whose x, y and z point to the letters A or P, L or R, S or I: "ALS". Empty
/// where no letter says what is up, or where they say an axis twice.
std::optional<Axes> axes_of_letters(std::string_view letters);

}  // namespace kinalign
