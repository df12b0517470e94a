// SPDX-License-Identifier: Apache-2.0
// The lab's key, the nodes' keys that are derived from it, and the files they stand in.
// docs/formats/imu_node.md, "Keys".
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/siphash.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

using LabKey = std::array<std::uint8_t, 32>;

/// The first 16 bytes of HMAC-SHA-256(lab key, "kinalign node key 7"), the id in decimal.
MacKey node_key(const LabKey& lab, std::uint32_t node_id);

/// Both are drawn from the system; a secret lasts for a run, and nobody is told it.
Result<LabKey> new_lab_key();
Result<SipHashKey> new_secret();

/// "000102…": two lowercase digits a byte.
std::string key_text(std::span<const std::uint8_t> key);

/// 64 hexadecimal digits and at most a line end. Refuses a file that others may read
/// (ErrorKind::exposed_key). A file that this user may not read is ErrorKind::forbidden_key, and
/// one that is not there ErrorKind::no_such_file. No message shows a byte of the file.
Result<LabKey> read_lab_key(FileSystem& files, const std::string& path);

/// The key's text and a line end, mode 0600. Refuses to overwrite anything: a lost key is a node
/// that has to be flashed again.
Result<void> write_key(FileSystem& files, const std::string& path,
                       std::span<const std::uint8_t> key);

/// The keys of all nodes, and for a minute after a change the ones before.
class KeyRing {
 public:
  static constexpr Duration old_key_lasts = std::chrono::seconds(60);

  /// Without a lab key no node has one, and a MAC can't be checked.
  explicit KeyRing(const std::optional<LabKey>& lab = std::nullopt) : now_(lab) {}

  bool keyed() const { return now_.lab.has_value(); }
  /// nullptr: none. Good until the next call.
  const MacKey* key_of(std::uint32_t node_id) { return now_.key_of(node_id); }
  const MacKey* old_key_of(std::uint32_t node_id, HostTime now);

  void replace(const LabKey& lab, HostTime now);

 private:
  /// Deriving a key takes a microsecond or two: the last ones are kept, by id modulo their number.
  struct Derived {
    explicit Derived(const std::optional<LabKey>& from) : lab(from), kept(from ? most : 0) {}
    const MacKey* key_of(std::uint32_t node_id);

    static constexpr std::size_t most = 256;
    struct Key {
      std::optional<std::uint32_t> node_id;
      MacKey key{};
    };
    std::optional<LabKey> lab;
    std::vector<Key> kept;
  };

  Derived now_;
  Derived before_{std::nullopt};
  HostTime before_ends_ = HostTime::min();
};

}  // namespace kinalign
