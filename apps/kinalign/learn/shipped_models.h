// SPDX-License-Identifier: Apache-2.0
// Finds the models that come with kinalign.
#pragma once

#include "kinalign/core/error.h"

#include <string>

namespace kinalign {

/// The file of a model that comes with kinalign ("denoise", "pose"). It is searched in
/// ../share/kinalign/models from the program's folder, then in the source tree from which the
/// program was built. Fails if the file is in neither folder.
Result<std::string> shipped_model(const std::string& name);

/// The file that --model means. `given` may be a file, or the name of a model that comes with
/// kinalign ("pose_head") if no file has this name. If `given` is empty, the model `usual` is used.
/// A text that is neither is returned as it is, so that reading it gives the error.
Result<std::string> model_named(const std::string& given, const std::string& usual);

/// The folder in which this program's file is.
std::string program_folder();

}  // namespace kinalign
