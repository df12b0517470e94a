// SPDX-License-Identifier: Apache-2.0
// Channels of a tracking system: the rows of channels.tsv, one for each column of motion.tsv.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/formats/bids/tsv_table.h"
#include "kinalign/formats/reader.h"
#include "kinalign/motion/clip.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

/// All are texts as in channels.tsv. "n/a" stands for a field without a meaning.
struct BidsChannel {
  std::string name, component, type, tracked_point, units, placement, reference_frame;
};

/// The header of a stream, from which its channels are made.
using BidsSource = std::variant<Skeleton, PointHeader, ImuHeader>;

// Components in the order of our arrays: x,y,z and w,x,y,z.
inline constexpr std::array<const char*, 3> bids_axes{"x", "y", "z"};
inline constexpr std::array<const char*, 4> bids_quaternion{"quat_w", "quat_x", "quat_y", "quat_z"};

/// The channels of a stream. LATENCY comes first. Then follow POS and ORNT of a skeleton's joints,
/// POS of points, or ORNT, ACCEL and GYRO of nodes as far as the stream has them. Positions and
/// orientations use the reference frame "global", accelerations and angular velocities "sensor".
/// The order is that of the columns of motion.tsv, so writer and table must use the same list.
std::vector<BidsChannel> bids_channels(const BidsSource& source);

/// The counts of channels and of tracked points that motion.json states, with their keys.
std::vector<std::pair<std::string, std::size_t>> bids_counts(std::span<const BidsChannel> channels);

TsvTable channels_table(std::span<const BidsChannel> channels);
/// Reads the channels back. Fails if one of the first five columns is missing; `file` appears in
/// messages.
/// The last two columns are optional in BIDS; a channel without them has "n/a".
Result<std::vector<BidsChannel>> channels_of(const TsvTable& table, std::string_view file);

/// True for a channel type of BIDS 1.9, in capitals.
bool is_bids_type(std::string_view type);
bool is_bids_component(std::string_view component);
/// Our units (m, rad, m/s2, ...) per `unit`; 0 if the type has no such unit.
/// A value in the file times this factor is in our unit.
double unit_scale(std::string_view type, std::string_view unit);

/// Our axes from a space whose x, y and z point towards the given letters, such as "ALS": A or P, L
/// or R, S or I. Empty if no letter says which axis is up, or if two letters name the same axis.
std::optional<Axes> axes_of_letters(std::string_view letters);

}  // namespace kinalign
