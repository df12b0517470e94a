// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/windows_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

// Signatures of ZIP records (PKWARE's APPNOTE.TXT): end of central directory, entry of the central
// directory, local header, ZIP64 end of central directory.
constexpr std::uint32_t end_mark = 0x06054b50, entry_mark = 0x02014b50, local_mark = 0x04034b50,
                        end64_mark = 0x06064b50;
/// Bytes of the fixed part of a ZIP record.
constexpr std::size_t end_size = 22, entry_size = 46, local_size = 30;
// Limits that keep sums and products of untrusted lengths within 64 bits.
constexpr std::size_t most_dimensions = 8;
constexpr std::size_t most_length = std::size_t{1} << 40U;  // length of one dimension
constexpr std::int64_t most_rows = std::int64_t{1} << 40U;

/// Little-endian numbers of the file. Beyond its end they are 0, which the callers' checks then
/// refuse.
class Bytes {
 public:
  explicit Bytes(std::string_view all) : all_(all) {}
  std::uint64_t number(std::size_t at, std::size_t size) const {
    std::uint64_t out = 0;
    for (std::size_t i = size; i-- > 0;) {
      const std::size_t place = at + i;
      out = out << 8U | (place < all_.size() ? static_cast<unsigned char>(all_[place]) : 0U);
    }
    return out;
  }
  bool holds(std::size_t at, std::uint64_t size) const {
    return at <= all_.size() && size <= all_.size() - at;
  }
  std::string_view piece(std::size_t at, std::size_t size) const { return all_.substr(at, size); }
  std::size_t size() const { return all_.size(); }

 private:
  std::string_view all_;
};

Failure broken(const std::string& name, std::string expected, std::string found) {
  return Failure(Error{name, 0, std::move(expected), std::move(found)});
}

/// A member of the ZIP: the size of its bytes, and the offset of its local header.
struct Entry {
  std::string name;
  std::uint64_t size = 0, at = 0;
};

/// Takes the size and the offset from the ZIP64 field if they do not fit into 32 bits.
void read_zip64(const Bytes& bytes, std::size_t extra, std::size_t length, Entry& entry) {
  for (std::size_t at = extra; at + 4 <= extra + length;) {
    const std::size_t size = bytes.number(at + 2, 2);
    if (bytes.number(at, 2) == 1) {
      std::size_t place = at + 4;
      if (entry.size == 0xffffffff) {
        entry.size = bytes.number(place, 8);
        place += 16;  // uncompressed and compressed size, equal for stored members
      }
      if (entry.at == 0xffffffff) entry.at = bytes.number(place, 8);
    }
    at += 4 + size;
  }
}

/// The offset of the end record. A ZIP comment of up to 65,535 bytes may follow it.
std::optional<std::size_t> find_end(const Bytes& bytes) {
  if (bytes.size() < end_size) return std::nullopt;
  const std::size_t last = bytes.size() - end_size;
  for (std::size_t back = 0; back <= std::min<std::size_t>(last, 65535); ++back) {
    if (bytes.number(last - back, 4) == end_mark) return last - back;
  }
  return std::nullopt;
}

/// Reads the ZIP's central directory.
Result<std::vector<Entry>> entries_of(const Bytes& bytes, const std::string& name) {
  const auto end = find_end(bytes);
  if (!end) return broken(name, "an NPZ (numpy.savez)", "no ZIP directory at the end");
  // A file with many or large members has its count and offset in the ZIP64 end record. A locator
  // of 20 bytes before the end record holds the offset of that record.
  std::uint64_t count = bytes.number(*end + 10, 2), at = bytes.number(*end + 16, 4);
  if ((count == 0xffff || at == 0xffffffff) && *end >= 20) {
    const std::uint64_t end64 = bytes.number(*end - 12, 8);
    if (bytes.holds(end64, 56) && bytes.number(end64, 4) == end64_mark) {
      count = bytes.number(end64 + 32, 8);
      at = bytes.number(end64 + 48, 8);
    }
  }
  std::vector<Entry> out;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!bytes.holds(at, entry_size) || bytes.number(at, 4) != entry_mark) {
      return broken(name, "an entry of the ZIP directory",
                    "no entry at byte " + std::to_string(at));
    }
    const std::size_t length = bytes.number(at + 28, 2), extra = bytes.number(at + 30, 2);
    if (!bytes.holds(at + entry_size, length + extra)) {
      return broken(name, "a complete entry", "the end of the file");
    }
    Entry entry{std::string(bytes.piece(at + entry_size, length)), bytes.number(at + 24, 4),
                bytes.number(at + 42, 4)};
    // Method 0 is «stored». Inflating would need a library, and arrays are read in place.
    if (bytes.number(at + 10, 2) != 0) {
      return broken(name, "arrays that are stored (numpy.savez, kinalign dataset windows)",
                    entry.name + ", which is compressed");
    }
    read_zip64(bytes, at + entry_size + length, extra, entry);
    out.push_back(std::move(entry));
    at += entry_size + length + extra + bytes.number(at + 32, 2);
  }
  return out;
}

/// The text after `key` in a NumPy header such as {'descr': '<f4', 'fortran_order': False, 'shape':
/// (2,)}.
std::string_view after(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  return at == std::string_view::npos ? std::string_view{} : header.substr(at + key.size());
}

/// Reads type and shape of a NumPy header; empty if it is not valid or in Fortran order.
/// The header is the text of a Python dictionary (NumPy's format .npy). NumPy always writes it in
/// one form, so this searches for the keys and does not parse Python.
std::optional<StoredArray> read_header(std::string_view header) {
  StoredArray out;
  std::string_view type = after(header, "'descr': '");
  out.type = type.substr(0, type.find('\''));
  if (after(header, "'fortran_order': ").substr(0, 5) != "False") return std::nullopt;
  std::string_view shape = after(header, "'shape': (");
  while (!shape.empty() && shape.front() != ')') {
    if (shape.front() == ' ' || shape.front() == ',') {
      shape.remove_prefix(1);
      continue;
    }
    std::size_t value = 0;
    const auto [end, fault] = std::from_chars(shape.data(), shape.data() + shape.size(), value);
    if (fault != std::errc() || value > most_length || out.shape.size() == most_dimensions) {
      return std::nullopt;
    }
    out.shape.push_back(value);
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
  }
  if (shape.empty()) return std::nullopt;
  return out;
}

/// Bytes per value, for example 48 for "<U12".
std::size_t value_size(const std::string& type) {
  if (type.size() < 3) return 0;
  std::size_t count = 0;
  std::from_chars(type.data() + 2, type.data() + type.size(), count);
  return type[1] == 'U' ? 4 * count : count;
}

/// Reads one member. Each length is checked against the bytes present before it is multiplied.
Result<StoredArray> read_array(std::string_view npy, const std::string& what) {
  const Bytes bytes(npy);
  if (npy.size() < 12 || npy.substr(0, 6) != "\x93NUMPY") {
    return broken(what, "an array of NumPy", "none");
  }
  // Version 1 of the format has a length of 2 bytes, later versions one of 4.
  const bool wide = npy[6] > 1;
  const std::size_t begin = wide ? 12 : 10, length = bytes.number(8, wide ? 4 : 2);
  if (!bytes.holds(begin, length)) return broken(what, "a complete header", "the end of the array");
  auto array = read_header(npy.substr(begin, length));
  if (!array) return broken(what, "a header of NumPy, in C order", "another header");
  std::size_t size = value_size(array->type);
  const std::size_t there = npy.size() - begin - length;
  for (const std::size_t one : array->shape) {
    if (one != 0 && size > there / one) return broken(what, "all of its values", "fewer");
    size *= one;
  }
  // Too many bytes are refused as well: the shape is then not that of the values.
  if (size != there)
    return broken(what, std::to_string(size) + " bytes of values", std::to_string(there));
  array->bytes = npy.substr(begin + length);
  return *array;
}

template <class Value>
void append_as_float(std::string_view bytes, std::vector<float>& out) {
  for (std::size_t at = 0; at + sizeof(Value) <= bytes.size(); at += sizeof(Value)) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    out.push_back(static_cast<float>(value));
  }
}

/// Appends `count` rows as floats; false if the type is not a number.
/// Networks compute in float, so values of all types are converted.
bool append_row(const StoredArray& array, std::size_t first, std::size_t count,
                std::vector<float>& out) {
  const std::size_t rows = array.shape.empty() ? 0 : array.shape[0];
  const std::size_t size = rows == 0 ? 0 : array.bytes.size() / rows;
  const std::string_view bytes = array.bytes.substr(first * size, count * size);
  if (array.type == "<f4")
    append_as_float<float>(bytes, out);
  else if (array.type == "<f8")
    append_as_float<double>(bytes, out);
  else if (array.type == "|u1")
    append_as_float<std::uint8_t>(bytes, out);
  else if (array.type == "<i4")
    append_as_float<std::int32_t>(bytes, out);
  else if (array.type == "<i8")
    append_as_float<std::int64_t>(bytes, out);
  else
    return false;
  return true;
}

Result<std::vector<std::int64_t>> integers(const std::map<std::string, StoredArray>& arrays,
                                           const std::string& key, const std::string& name) {
  const auto found = arrays.find(key);
  if (found == arrays.end()) return broken(name, "an array " + key, "none");
  const StoredArray& array = found->second;
  const std::size_t size = value_size(array.type);
  const bool has_sign = array.type.size() > 1 && array.type[1] == 'i';
  if (size == 0 || size > 8 || (!has_sign && array.type[1] != 'u')) {
    return broken(name, key + " of integers", array.type);
  }
  // Bits above the value; the shifts extend its sign into them.
  const std::size_t unused = 8 * (8 - size);
  std::vector<std::int64_t> out;
  for (std::size_t at = 0; at + size <= array.bytes.size(); at += size) {
    const std::uint64_t bits = Bytes(array.bytes).number(at, size);
    const auto value = static_cast<std::int64_t>(bits << unused) >> unused;
    out.push_back(has_sign ? value : static_cast<std::int64_t>(bits));
  }
  return out;
}

/// Converts NumPy's UTF-32 text to UTF-8.
/// The manifest is such a text: NumPy has no other type for a single string.
std::string utf8_of(const StoredArray& array) {
  std::string out;
  for (std::size_t at = 0; at + 4 <= array.bytes.size(); at += 4) {
    const auto code = static_cast<std::uint32_t>(Bytes(array.bytes).number(at, 4));
    // NumPy fills texts shorter than the type's length with zeros.
    if (code == 0) continue;
    if (code < 0x80) {
      out += static_cast<char>(code);
    } else if (code < 0x800) {
      out += static_cast<char>(0xc0U | code >> 6U);
      out += static_cast<char>(0x80U | (code & 0x3fU));
    } else {
      if (code < 0x10000) {
        out += static_cast<char>(0xe0U | code >> 12U);
      } else {
        out += static_cast<char>(0xf0U | (code >> 18U & 0x07U));
        out += static_cast<char>(0x80U | (code >> 12U & 0x3fU));
      }
      out += static_cast<char>(0x80U | (code >> 6U & 0x3fU));
      out += static_cast<char>(0x80U | (code & 0x3fU));
    }
  }
  return out;
}

WindowsFacts::Stream stream_of(const nlohmann::json& json) {
  WindowsFacts::Stream out{json.at("name").get<std::string>(), json.value("kind", ""), {}, {}};
  if (json.contains("names")) json.at("names").get_to(out.names);
  if (json.contains("parents")) json.at("parents").get_to(out.parents);
  return out;
}

/// Reads the file's manifest, which lists its streams and arrays.
Result<WindowsFacts> read_facts(const std::string& text, const std::string& name) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("schema") || json.at("schema") != "kinalign.windows/1") {
    return broken(name, "a manifest of schema kinalign.windows/1", "another schema");
  }
  WindowsFacts out;
  try {
    out.dataset = json.value("dataset", "");
    out.licence = json.value("licence", "");
    out.citation = json.value("citation", "");
    out.rate_hz = json.at("rate_hz").get<double>();
    json.at("parts").get_to(out.parts);
    for (const auto& take : json.at("takes")) {
      out.takes.push_back(
          {take.value("name", ""), take.value("subject", ""), take.value("action", "")});
    }
    for (const auto& stream : json.at("streams")) out.streams.push_back(stream_of(stream));
  } catch (const nlohmann::json::exception& fault) {
    return broken(name, "a complete manifest", shown(fault.what()));
  }
  return out;
}

/// For each window: take, part, number of rows, and stamp of its first row.
struct Places {
  std::vector<std::int64_t> take, part, rows, time_ns;
};

/// True if the array `key` has one row of the stream for each row of a window: [N,T,...].
bool is_of_rows(const std::string& key, const std::string& stream, const StoredArray& array) {
  return key.starts_with(stream + "_") && array.shape.size() > 2 && !key.ends_with("_rest_offsets");
}

using Arrays = std::map<std::string, StoredArray>;

/// Rows `skip` ... `skip` + `rows` - 1 of a window.
struct Piece {
  std::size_t window, skip, rows;
};

/// Appends the piece to the last stretch.
Result<void> append_piece(const Arrays& arrays, const Piece& piece, Windows& out,
                          const std::string& name) {
  Stretch& stretch = out.stretches.back();
  for (const WindowsFacts::Stream& about : out.facts.streams) {
    const std::string& stream = about.name;
    for (const auto& [key, array] : arrays) {
      if (!is_of_rows(key, stream, array)) continue;
      const std::size_t length = array.shape[1];
      std::vector<std::size_t> flat{array.shape[0] * length};
      flat.insert(flat.end(), array.shape.begin() + 2, array.shape.end());
      const StoredArray lines{array.type, flat, array.bytes};
      if (piece.skip + piece.rows > length || piece.window >= array.shape[0]) {
        return broken(name, key + " with a row for each", "fewer");
      }
      if (!append_row(lines, piece.window * length + piece.skip, piece.rows,
                      stretch.streams[stream].arrays[key.substr(stream.size() + 1)])) {
        return broken(name, key + " of numbers", array.type);
      }
    }
  }
  stretch.rows += piece.rows;
  return {};
}

/// The number of rows from the start of window `w` - 1 to that of window `w`. It uses stamps,
/// because `first` is rounded if the windows have another rate than the take.
/// A step that is too long gives a number beyond most_rows, which join() refuses; llround() of it
/// would overflow.
std::int64_t rows_between(const Places& places, std::size_t w, double rate_hz) {
  const double step =
      static_cast<double>(places.time_ns[w]) - static_cast<double>(places.time_ns[w - 1]);
  const double rows = step * 1e-9 * rate_hz;
  return std::abs(rows) < static_cast<double>(most_rows) ? std::llround(rows) : 2 * most_rows;
}

/// Joins windows that overlap or follow each other to stretches.
/// Windows are cut with an overlap (docs/windows.md), so most rows occur twice. `begin` is the row
/// of the take at which window `w` begins, `reached` the row after the last one appended; only rows
/// from there on are new.
Result<void> join(const Arrays& arrays, const Places& places, Windows& out,
                  const std::string& name) {
  std::int64_t begin = 0, reached = 0;
  for (std::size_t w = 0; w < places.take.size(); ++w) {
    const std::int64_t rows = places.rows[w];
    if (rows <= 0 || rows > most_rows) {
      return broken(name, "rows of a window", std::to_string(rows));
    }
    const bool same_take = w > 0 && places.take[w] == places.take[w - 1];
    const std::int64_t step = same_take ? rows_between(places, w, out.facts.rate_hz) : 0;
    begin = same_take ? begin + step : 0;
    if (begin > most_rows || begin < -most_rows) {
      return broken(name, "stamps of a take", std::to_string(begin) + " rows in it");
    }
    // A window that repeats only known rows, or that begins after a gap, starts a new stretch.
    const bool goes_on = same_take && begin <= reached && begin + rows > reached &&
                         places.time_ns[w] > places.time_ns[w - 1];
    if (!goes_on) {
      out.stretches.push_back({static_cast<std::size_t>(places.take[w]),
                               static_cast<std::size_t>(places.part[w]),
                               0,
                               {}});
      reached = begin;
    }
    const Piece piece{w, static_cast<std::size_t>(reached - begin),
                      static_cast<std::size_t>(begin + rows - reached)};
    KA_TRY(append_piece(arrays, piece, out, name));
    reached = begin + rows;
  }
  return {};
}

Result<Places> places_of(const Arrays& arrays, const std::string& name) {
  // Filled member by member: GCC leaks the earlier members of a braced list if a later one returns
  // early.
  Places out;
  out.take = KA_TRY(integers(arrays, "take", name));
  out.part = KA_TRY(integers(arrays, "part", name));
  out.rows = KA_TRY(integers(arrays, "rows", name));
  out.time_ns = KA_TRY(integers(arrays, "time_ns", name));
  const std::size_t count = out.take.size();
  if (out.part.size() == count && out.rows.size() == count && out.time_ns.size() == count) {
    return out;
  }
  return broken(name, "arrays of one length", "take, part, rows and time_ns differ");
}

}  // namespace

const WindowsFacts::Stream* WindowsFacts::find(const std::string& stream) const {
  const auto found = std::find_if(streams.begin(), streams.end(),
                                  [&](const Stream& one) { return one.name == stream; });
  return found == streams.end() ? nullptr : &*found;
}

std::size_t StoredArray::row() const {
  std::size_t out = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) out *= shape[i];
  return out;
}

Result<std::map<std::string, StoredArray>> stored_arrays(std::string_view npz,
                                                         const std::string& name) {
  const Bytes bytes(npz);
  std::map<std::string, StoredArray> out;
  for (const Entry& entry : KA_TRY(entries_of(bytes, name))) {
    if (!bytes.holds(entry.at, local_size) || bytes.number(entry.at, 4) != local_mark) {
      return broken(name, entry.name + " where the ZIP directory says", "another entry");
    }
    // Name and extra field of the local header may be longer than those of the directory.
    const std::size_t begin =
        entry.at + local_size + bytes.number(entry.at + 26, 2) + bytes.number(entry.at + 28, 2);
    if (!bytes.holds(begin, entry.size)) {
      return broken(name, "all of " + entry.name, "the end of the file");
    }
    const std::string key = entry.name.substr(0, entry.name.rfind(".npy"));
    out[key] = KA_TRY(read_array(bytes.piece(begin, entry.size), name + ": " + entry.name));
  }
  return out;
}

Result<Windows> read_windows(std::string_view npz, const std::string& name) {
  const auto arrays = KA_TRY(stored_arrays(npz, name));
  const auto manifest = arrays.find("manifest");
  if (manifest == arrays.end()) {
    return broken(name, "a file of kinalign dataset windows", "no array manifest");
  }
  Windows out;
  out.facts = KA_TRY(read_facts(utf8_of(manifest->second), name));
  const Places places = KA_TRY(places_of(arrays, name));
  KA_TRY(join(arrays, places, out, name));
  for (const auto& [key, array] : arrays) {
    const std::size_t at = key.rfind("_rest_offsets");
    // Rest offsets have a row for each take, not for each window, so join() leaves them out.
    if (at == std::string::npos || array.shape.empty()) continue;
    append_row(array, 0, array.shape[0], out.rest_offsets[key.substr(0, at)]);
  }
  return out;
}

}  // namespace kinalign
