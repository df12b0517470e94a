// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace kinalign::hdf5 {

static_assert(std::is_same_v<Id, hid_t> && std::is_same_v<Size, hsize_t> &&
              std::is_same_v<int, herr_t>);

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(bytes, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle space(const std::vector<hsize_t>& sizes) {
  if (sizes.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), 0);
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose};
}

Handle create_dataset(hid_t parent, const std::string& name, const Shape& shape) {
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), 0);
  H5Pset_layout(creation.id(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  return {H5Dcreate2(parent, name.c_str(), shape.type, space(shape.sizes).id(), H5P_DEFAULT,
                     creation.id(), H5P_DEFAULT),
          H5Dclose};
}

bool put_attribute(hid_t object, const char* name, const Shape& shape, const void* value) {
  const Handle attribute(
      H5Acreate2(object, name, shape.type, space(shape.sizes).id(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  return attribute.good() && H5Awrite(attribute.id(), shape.type, value) >= 0;
}

bool put_text(hid_t object, const char* name, std::string_view text) {
  const std::string bytes = text.empty() ? std::string(1, '\0') : std::string(text);
  return put_attribute(object, name, {text_type(bytes.size()).id(), {}}, bytes.data());
}

bool put_texts(hid_t object, const char* name, const std::vector<std::string>& texts) {
  if (texts.empty()) return true;
  const PackedTexts packed = pack(texts);
  return put_attribute(object, name, {text_type(packed.width).id(), {texts.size()}},
                       packed.bytes.data());
}

PackedTexts pack(const std::vector<std::string>& texts) {
  PackedTexts packed;
  for (const std::string& text : texts) packed.width = std::max(packed.width, text.size());
  for (const std::string& text : texts) {
    packed.bytes += text;
    packed.bytes.append(packed.width - text.size(), '\0');
  }
  return packed;
}

std::vector<std::string> unpack(std::string_view bytes, std::size_t width) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at + width <= bytes.size(); at += width) {
    const std::string_view text = bytes.substr(at, width);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

}  // namespace kinalign::hdf5
