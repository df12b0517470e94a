// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/lab_toml.h"

#include "kinalign/core/files.h"
#include "kinalign/documents/toml_entries.h"

#include <toml++/toml.h>

#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_devices = 64;

class LabReader {
 public:
  explicit LabReader(std::string_view name) : name_(name), file_(name) {}

  Result<std::vector<DeviceOptions>> read(const toml::table& top) const {
    const toml::node* devices = top.get("device");
    if (devices == nullptr) return std::vector<DeviceOptions>();
    Lab lab;
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table({"device", devices})))) {
      lab.devices.push_back(KA_TRY(read_device(entry)));
      const auto good = validate(lab);  // validates all devices so far, so a fault is in this
                                        // line's device
      if (!good) return file_.at(*entry.value, good.error());
      if (lab.devices.size() > most_devices) {
        return file_.at(*entry.value,
                        Error{"", 0, std::to_string(most_devices) + " devices at most", "more"});
      }
    }
    return std::move(lab.devices);
  }

 private:
  Result<DeviceOptions> read_device(const TomlEntry& device) const {
    if (!device.value->is_table()) {
      return file_.at(*device.value, Error{"", 0, "[device.NAME], a table of its own for each",
                                           device.key + ", " + type_of(*device.value)});
    }
    DeviceOptions out;
    out.name = device.key;
    const Fields fields = describe(out);
    for (const TomlEntry& entry : in_file_order(KA_TRY(file_.table(device)))) {
      if (entry.key == "nodes") {
        out.nodes = KA_TRY(file_.texts(entry));
      } else {
        KA_TRY(file_.option(entry, fields, "device." + device.key, {"nodes"}));
      }
    }
    for (std::string* path : {&out.skeleton, &out.lab_key}) {
      if (!path->empty() && !path->starts_with('/')) path->insert(0, folder(name_));
    }
    return out;
  }

  std::string name_;
  TomlFile file_;
};

}  // namespace

Result<std::vector<DeviceOptions>> read_devices(std::string_view toml, std::string_view name) {
  std::vector<DeviceOptions> devices;
  KA_TRY(TomlFile(name).parse(toml, [&](const toml::table& top) -> Result<void> {
    devices = KA_TRY(LabReader(name).read(top));
    return {};
  }));
  return devices;
}

}  // namespace kinalign
