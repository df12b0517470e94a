// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/shipped_models.h"

#include <filesystem>

namespace kinalign {

std::string program_folder() {
  std::error_code fault;
  // Linux makes this link to the program's real file, even if the program was started through
  // another link.
  return std::filesystem::read_symlink("/proc/self/exe", fault).parent_path();
}

Result<std::string> shipped_model(const std::string& name) {
  const std::filesystem::path own = program_folder();
  // After installation the program is in PREFIX/bin and the models are in PREFIX/share. In a build
  // tree they are in TREE/build/PRESET/apps/kinalign and TREE/models.
  for (const auto& folder : {own / "../share/kinalign/models", own / "../../../../models"}) {
    const auto file = (folder / (name + ".safetensors")).lexically_normal();
    std::error_code fault;
    if (std::filesystem::exists(file, fault)) return file.string();
  }
  const std::string installed = (own / "../share/kinalign/models").lexically_normal().string();
  return Failure(Error{"--model", 0,
                       "a model's file, because no model " + name + " is in " + installed, "none"});
}

Result<std::string> model_named(const std::string& given, const std::string& usual) {
  if (given.empty()) return shipped_model(usual);
  std::error_code fault;
  // A text without '.' and '/' is the name of a model, unless there is a file with this name.
  const bool is_name = given.find_first_of("./") == std::string::npos;
  if (!is_name || std::filesystem::exists(given, fault)) return given;
  // An unknown name is returned as it is. Reading it then fails with "no such file" and the user's
  // word.
  return shipped_model(given).value_or(given);
}

}  // namespace kinalign
