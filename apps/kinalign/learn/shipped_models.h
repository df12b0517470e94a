// SPDX-License-Identifier: Apache-2.0
// The models that come with the program.
#pragma once

#include "kinalign/core/error.h"

#include <string>

namespace kinalign {

/// The file of the shipped model of that name ("denoise", "pose"): in ../share/kinalign/models
/// beside the program's folder, or in the tree that it was built from. Fails where there is none.
Result<std::string> shipped_model(const std::string& name);

/// The model that --model names: a file, or a shipped one by its name ("pose_head") where no file
/// is called that. `usual`: the shipped one where `given` is empty.
Result<std::string> model_named(const std::string& given, const std::string& usual);

/// The folder of this program.
std::string program_folder();

}  // namespace kinalign
