// SPDX-License-Identifier: Apache-2.0
// The channels of a tracking system. A channel is a row of channels.tsv and a column of motion.tsv.
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

/// One channel. All fields are texts as in channels.tsv; "n/a" means that a field has no value.
struct BidsChannel {
  std::string name, component, type, tracked_point, units, placement, reference_frame;
};

/// The header of a stream. Its channels are made from it.
using BidsSource = std::variant<Skeleton, PointHeader, ImuHeader>;

// The components in the order of kinalign's arrays: x,y,z and w,x,y,z.
inline constexpr std::array<const char*, 3> bids_axes{"x", "y", "z"};
inline constexpr std::array<const char*, 4> bids_quaternion{"quat_w", "quat_x", "quat_y", "quat_z"};

/// The channels of a stream, in the order of the columns in motion.tsv. LATENCY comes first. A
/// skeleton has POS and ORNT for each joint, and points have POS. Nodes have ORNT, ACCEL and GYRO
/// if the stream has these quantities. Positions and orientations have the reference frame
/// "global". Accelerations and angular velocities have "sensor".
std::vector<BidsChannel> bids_channels(const BidsSource& source);

/// The counts of channels and of tracked points in motion.json, with their keys.
std::vector<std::pair<std::string, std::size_t>> bids_counts(std::span<const BidsChannel> channels);

TsvTable channels_table(std::span<const BidsChannel> channels);
/// Reads the channels in a table. `file` appears in messages. Fails if one of the first five
/// columns is missing. The last two columns are optional in BIDS; without them the fields are
/// "n/a".
Result<std::vector<BidsChannel>> channels_of(const TsvTable& table, std::string_view file);

/// True for a channel type of BIDS 1.9 in upper case.
bool is_bids_type(std::string_view type);
bool is_bids_component(std::string_view component);
/// The factor that converts a value in `unit` to kinalign's unit (m, rad, m/s2 and so on); 0 if the
/// type does not allow this unit.
double unit_scale(std::string_view type, std::string_view unit);

/// The conversion to kinalign's axes from a space whose x, y and z axes point in the directions of
/// the letters, for example "ALS". The letters are A or P, L or R, S or I. The result is empty if
/// no letter names the up axis, or if two letters name the same axis.
std::optional<Axes> axes_of_letters(std::string_view letters);

}  // namespace kinalign
