// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/archive/npz.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// True if the shapes are equal. A wanted length of 0 accepts any length.
bool fits(const Shape& found, const Shape& wanted) {
  if (found.size() != wanted.size()) return false;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] != 0 && found[i] != wanted[i]) return false;
  }
  return true;
}

std::string words_of(const Shape& shape) {
  std::string text;
  for (const std::uint64_t one : shape) {
    text += (text.empty() ? "" : " x ") + (one == 0 ? "n" : std::to_string(one));
  }
  return shape.empty() ? "one value" : text;
}

template <class Value, class Get>
std::vector<Value> all_of(const NpyArray& array, const Get& get) {
  std::vector<Value> out;
  const std::uint64_t count = array.header.values();
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(get(array, i));
  return out;
}

}  // namespace

Result<Npz> Npz::read(const ArchiveBytes& bytes, const ArchiveLimits& limits) {
  Npz out;
  out.name_ = bytes.name;
  KA_TRY(read_archive(
      bytes, limits, [&](const std::string& name, const ArchivePieces& next) -> Result<void> {
        std::string file;
        for (;;) {
          const std::string_view piece = KA_TRY(next());
          if (piece.empty()) break;
          file += piece;
        }
        // A file with other members is not an NPZ file of arrays.
        if (!name.ends_with(".npy")) {
          return refuse(bytes.name, "only arrays, NAME.npy", shown(name));
        }
        Member& member = out.arrays_[name.substr(0, name.size() - 4)];
        member.bytes = std::move(file);
        member.array = KA_TRY(read_npy(member.bytes, bytes.name + ": " + shown(name)));
        return {};
      }));
  return out;
}

/// The array with this name. `kinds`: the letters of NpyHeader::kind that the caller accepts.
Result<const NpyArray*> Npz::find(const std::string& name, std::string_view kinds,
                                  const Shape& shape) const {
  const auto at = arrays_.find(name);
  if (at == arrays_.end()) return refuse(name_, "an array " + name, "none");
  const NpyHeader& header = at->second.array.header;
  if (kinds.find(header.kind) == kinds.npos) {
    return refuse(name_, fmt::format("values of another type in {}", name),
                  fmt::format("numpy's '{}'", header.kind));
  }
  if (!fits(header.shape, shape)) {
    return refuse(name_, fmt::format("{} of {}", name, words_of(shape)), words_of(header.shape));
  }
  return &at->second.array;
}

Result<std::vector<std::int64_t>> Npz::integers(const std::string& name, const Shape& shape) const {
  return all_of<std::int64_t>(*KA_TRY(find(name, "iu", shape)), integer_at);
}

Result<std::vector<double>> Npz::numbers(const std::string& name, const Shape& shape) const {
  return all_of<double>(*KA_TRY(find(name, "iuf", shape)), number_at);
}

Result<std::vector<std::string>> Npz::texts(const std::string& name, const Shape& shape) const {
  return all_of<std::string>(*KA_TRY(find(name, "U", shape)), text_at);
}

}  // namespace kinalign
