// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/lab_toml.h"

#include "kinalign/core/files.h"
#include "kinalign/syntax/toml.h"

#include <utility>

namespace kinalign {

namespace {

// Limits the work for a file from another person, because every pair of devices is compared.
constexpr std::size_t most_devices = 64;

/// Reads one device. Relative paths become relative to `in`, the folder of the file.
Result<DeviceOptions> read_device(const Value& device, const std::string& in) {
  // Users often write [device] with the keys of a device but without its name.
  if (!device.is_table()) {
    return at(device, "[device.NAME], a table of its own for each",
              device.key + ", " + shown(device));
  }
  DeviceOptions out;
  out.name = device.key;
  KA_TRY(read_options(device, describe(out)));
  // Paths are relative to the file, because the program may be started in any folder.
  for (std::string* path : {&out.skeleton, &out.lab_key}) {
    if (!path->empty() && !path->starts_with('/')) path->insert(0, in);
  }
  return out;
}

}  // namespace

Result<std::vector<DeviceOptions>> read_devices(std::string_view toml, std::string_view name) {
  Lab lab;
  KA_TRY(read_toml(toml, name, [&](const Value& top) -> Result<void> {
    const Value* devices = top.find({"device"});
    if (devices == nullptr) return {};
    for (const Value& device : KA_TRY(entries_of(*devices))) {
      lab.devices.push_back(KA_TRY(read_device(device, std::string(folder(name)))));
      // All earlier devices were valid, so a fault belongs to the device of this line.
      const auto good = validate(lab);
      if (!good) return at(device, good.error());
      if (lab.devices.size() > most_devices) {
        return at(device, std::to_string(most_devices) + " devices at most", "more");
      }
    }
    return {};
  }));
  return std::move(lab.devices);
}

}  // namespace kinalign
