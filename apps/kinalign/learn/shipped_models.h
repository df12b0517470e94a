// SPDX-License-Identifier: Apache-2.0
// The models that come with the program.
#pragma once

#include "kinalign/core/error.h"

#include <string>

namespace kinalign {

/// The file of the shipped model with that name ("denoise", "pose"). Searches
/// ../share/kinalign/models from the program's folder, then the tree that the program was built
/// from. Fails if neither has it.
Result<std::string> shipped_model(const std::string& name);

/// The model that --model names: a file, or the name of a shipped model ("pose_head") if no file
/// has that name. `usual`: the shipped model if `given` is empty.
/// A name has neither '.' nor '/'. Anything else is returned as it is, so that reading it gives the
/// error.
Result<std::string> model_named(const std::string& given, const std::string& usual);

/// The folder of this program.
std::string program_folder();

}  // namespace kinalign
