// SPDX-License-Identifier: Apache-2.0
// A temporary folder for files that are needed only while the program runs.
#pragma once

#include "kinalign/core/error.h"

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <utility>

namespace kinalign {

/// A temporary folder. The destructor removes it with its content.
class Scratch {
 public:
  static Result<Scratch> make() {
    std::error_code fault;
    const auto temporary = std::filesystem::temp_directory_path(fault);
    if (fault) {
      return Failure(Error{"TMPDIR", 0, "a folder for temporary files", fault.message()});
    }
    std::string name = (temporary / "kinalign-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      return Failure(Error{name, 0, "room for a temporary folder", "none"});
    }
    return Scratch(std::move(name));
  }
  // The other object gets an empty name, so its destructor removes nothing.
  Scratch(Scratch&& other) noexcept : name_(std::exchange(other.name_, {})) {}
  Scratch& operator=(Scratch&&) = delete;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  // An error while removing is ignored, because it does not change the verb's result.
  ~Scratch() {
    std::error_code ignored;
    if (!name_.empty()) std::filesystem::remove_all(name_, ignored);
  }
  const std::string& name() const { return name_; }

 private:
  explicit Scratch(std::string name) : name_(std::move(name)) {}
  std::string name_;
};

}  // namespace kinalign
