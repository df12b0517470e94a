// SPDX-License-Identifier: Apache-2.0
// The keys of all nodes, and for a minute after a change the ones before.
#pragma once

#include "kinalign/capture/node_keys.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

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
