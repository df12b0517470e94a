// SPDX-License-Identifier: Apache-2.0
// How a take names the files it was made from: as the manifest does, never by a place on a machine.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// A path in `folder` ("" or ending in '/') where it is relative; an absolute one as it stands.
std::string path_in(const std::string& folder, const std::string& path);

/// The path, however it is spelt ("./a", "b/../a"), where it is relative and does not lead up; else
/// the file's name only.
std::string remembered_path(const std::string& path);

/// All paths of a manifest and their names. Where two files would have one name, those that lie
/// elsewhere get as many of their folders as tell them apart: Kinect/m01.txt and
/// Vicon/m01.txt. Paths of which one is the end of the other stay as they are: both may be one
/// file.
std::map<std::string, std::string> remembered_paths(const std::vector<std::string>& paths);

/// The name of `other`, which the reader of `path`, a file called `name`, opens by itself: from
/// `name` it is as far as from `path`.
std::string remembered_beside(const std::string& name, const std::string& path,
                              const std::string& other);

/// The same for `path`, a file that `given`, a path of a manifest in `folder`, led to.
std::string remembered_path(const std::string& folder, const std::string& given,
                            const std::string& path);

}  // namespace kinalign
