// SPDX-License-Identifier: Apache-2.0
// The names under which a take stores its input files: as in the manifest, never a place on one
// machine.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The path in `folder` ("" or ending in '/') if it is relative; an absolute path stays.
std::string path_in(const std::string& folder, const std::string& path);

/// The normalised path ("./a" and "b/../a" give "a") if it is relative and does not lead up; else
/// the file's name only.
std::string remembered_path(const std::string& path);

/// The names of all paths of a manifest. If two files would have one name, those outside the folder
/// get as many of their folders as are needed to differ: Kinect/m01.txt and Vicon/m01.txt. If one
/// path is the end of the other, both stay, since they may be one file.
std::map<std::string, std::string> remembered_paths(const std::vector<std::string>& paths);

/// The name of `other`, a file that the reader of `path` opens itself. `path` is stored as `name`;
/// the new name has the same position relative to it.
std::string remembered_sibling(const std::string& name, const std::string& path,
                               const std::string& other);

/// The same for `path`, a file found through `given`, a path of a manifest in `folder`.
std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path);

}  // namespace kinalign
