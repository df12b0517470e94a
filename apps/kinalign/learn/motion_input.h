// SPDX-License-Identifier: Apache-2.0
// Opens the inputs of the verbs `denoise`, `pose` and `fuse` that are not takes.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/verbs/inputs.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The stream that the user wants. Without a name, the only suitable stream is used. Errors name
/// `flag`.
struct WantedStream {
  std::string name{};
  std::string_view flag = "--stream";
};

/// A stream that the user can choose by its name. `is_usual`: it may also be used if no name is
/// given.
struct StreamChoice {
  std::string name;
  std::size_t index = 0;  // its index in the take or file
  bool is_usual = true;
};

/// The index of the wanted stream. Fails if no stream is suitable, or several are; the error lists
/// all names. `kind`: what the streams contain, such as "joints".
Result<std::size_t> choose_stream(const std::vector<StreamChoice>& all, const WantedStream& wanted,
                                  std::string_view kind, const std::string& path);

/// Opens a manifest, a recording or the file of a single stream. Of a recording, all devices are
/// opened whose data can be read as rows; a device that can't be read is left out.
Result<Input> open_motion(const std::string& path, Call& call);

/// The warnings and errors of a stream that was read to its end, one line each. The words are those
/// of `kinalign check`.
std::vector<std::string> warnings_of(const RecordedStream& stream);

}  // namespace kinalign
