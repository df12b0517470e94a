// SPDX-License-Identifier: Apache-2.0
// The names under which a take stores its input files. A name does not reveal a location on one
// machine.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Returns the path in `folder` ("" or ending in '/') if it is relative. An absolute path is
/// unchanged.
std::string path_in(const std::string& folder, const std::string& path);

/// Returns the normalised path ("./a" and "b/../a" give "a") if it is relative and stays inside the
/// folder. Otherwise returns only the file's name.
std::string remembered_path(const std::string& path);

/// Returns the names for all paths of a manifest. If two files outside the manifest's folder would
/// have the same name, as many of their folders are added as are needed: Kinect/m01.txt and
/// Vicon/m01.txt. If one path is the end of another path, both keep the same name, since they may
/// be the same file.
std::map<std::string, std::string> remembered_paths(const std::vector<std::string>& paths);

/// Returns the name of `other`, a file that the reader of `path` opens. `path` is stored as `name`;
/// the new name has the same position relative to `name` as `other` has to `path`.
std::string remembered_sibling(const std::string& name, const std::string& path,
                               const std::string& other);

/// Returns the name of `path`, a file found through `given`, a path of a manifest in `folder`.
std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path);

}  // namespace kinalign
