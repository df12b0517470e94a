// SPDX-License-Identifier: Apache-2.0
// The lab key, the node keys derived from it, and the key files. See "Keys" in
// docs/formats/imu_node_example.md.
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

/// The first 16 bytes of HMAC-SHA-256(lab key, "kinalign node key 7"); 7 is the node id in decimal.
MacKey node_key(const LabKey& lab, std::uint32_t node_id);

/// Random values from the system. A secret is used in one run only and is never stored or sent.
Result<LabKey> new_lab_key();
Result<SipHashKey> new_secret();

/// The key as text, "000102…": two lowercase hexadecimal digits per byte.
std::string key_text(std::span<const std::uint8_t> key);

/// Reads a key file: 64 hexadecimal digits and at most one line end. A file that other users may
/// read is refused (ErrorKind::exposed_key). If this user may not read the file, the error is
/// ErrorKind::forbidden_key. If the file does not exist, the error is ErrorKind::no_such_file. No
/// message shows a byte of the file.
Result<LabKey> read_lab_key(FileSystem& files, const std::string& path);

/// Writes the key as text with a line end to a new file of mode 0600. An existing file is never
/// overwritten, because nodes whose key is lost must be flashed again.
Result<void> write_key(FileSystem& files, const std::string& path,
                       std::span<const std::uint8_t> key);

/// The keys of all nodes. After a change of the lab key, the previous keys stay valid for a minute,
/// because nodes get their new keys one after another.
class KeyRing {
 public:
  static constexpr Duration old_key_lasts = std::chrono::seconds(60);

  /// Without a lab key no node has a key, and no MAC can be checked.
  explicit KeyRing(const std::optional<LabKey>& lab = std::nullopt) : now_(lab) {}

  bool keyed() const { return now_.lab.has_value(); }
  /// Returns nullptr if there is no lab key. The pointer is valid until the next call.
  const MacKey* key_of(std::uint32_t node_id) { return now_.key_of(node_id); }
  const MacKey* old_key_of(std::uint32_t node_id, HostTime now);

  void replace(const LabKey& lab, HostTime now);

 private:
  /// A cache of derived keys, indexed by id modulo `most`. Deriving a key takes 1 to 2 us.
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
