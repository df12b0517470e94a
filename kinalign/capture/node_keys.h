// SPDX-License-Identifier: Apache-2.0
// The lab's key, the nodes' keys that are derived from it, and the files they stand in.
// docs/formats/imu_node.md, "Keys".
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/siphash.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

using LabKey = std::array<std::uint8_t, 32>;

/// The first 16 bytes of HMAC-SHA-256(lab key, "kinalign node key 7"), the id in decimal.
MacKey node_key(const LabKey& lab, std::uint32_t node_id);

/// Both are drawn from the system; a secret lasts for a run, and nobody is told it.
Result<LabKey> new_lab_key();
Result<SipHashKey> new_secret();

/// "000102…": two lowercase digits a byte.
std::string key_text(std::span<const std::uint8_t> key);

/// What read_lab_key expected of a file that others may read, for who advises.
inline constexpr std::string_view secret_key = "a key that nobody else may read (chmod 600)";

/// What it found of a file that is another user's begins so, and goes on with whose and which mode.
inline constexpr std::string_view no_permission = "no permission to read it";

/// 64 hexadecimal digits and at most a line end. Refuses a file that others may read; no message
/// shows a byte of it.
Result<LabKey> read_lab_key(FileSystem& files, const std::string& path);

/// The key's text and a line end, mode 0600. Refuses to overwrite anything: a lost key is a node
/// that has to be flashed again.
Result<void> write_key(FileSystem& files, const std::string& path,
                       std::span<const std::uint8_t> key);

}  // namespace kinalign
