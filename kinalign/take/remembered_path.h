// SPDX-License-Identifier: Apache-2.0
// How a take names the files it was made from: as the manifest does, never by a place on a machine.
#pragma once

#include <string>

namespace kinalign {

/// A path in `folder` ("" or ending in '/') where it is relative; an absolute one as it stands.
std::string path_in(const std::string& folder, const std::string& path);

/// The path, however it is spelt ("./a", "b/../a"), where it is relative and does not lead up; else
/// the file's name only.
std::string remembered_path(const std::string& path);

/// The same for `path`, a file that `given`, a path of a manifest in `folder`, led to.
std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path);

}  // namespace kinalign
