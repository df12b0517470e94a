// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/windows_file.h"

#include "kinalign/core/find_named.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
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
// A limit that keeps sums and products of untrusted numbers within 64 bits.
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
  if (!end) return refuse(name, "an NPZ (numpy.savez)", "no ZIP directory at the end");
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
      return refuse(name, "an entry of the ZIP directory",
                    "no entry at byte " + std::to_string(at));
    }
    const std::size_t length = bytes.number(at + 28, 2), extra = bytes.number(at + 30, 2);
    if (!bytes.holds(at + entry_size, length + extra)) {
      return refuse(name, "a complete entry", "the end of the file");
    }
    Entry entry{std::string(bytes.piece(at + entry_size, length)), bytes.number(at + 24, 4),
                bytes.number(at + 42, 4)};
    // Method 0 is «stored». Inflating would need a library, and arrays are read in place.
    if (bytes.number(at + 10, 2) != 0) {
      return refuse(name, "arrays that are stored (numpy.savez, kinalign dataset windows)",
                    entry.name + ", which is compressed");
    }
    read_zip64(bytes, at + entry_size + length, extra, entry);
    out.push_back(std::move(entry));
    at += entry_size + length + extra + bytes.number(at + 32, 2);
  }
  return out;
}

using Arrays = std::map<std::string, NpyArray>;

/// Appends `count` of the array's `rows` rows as floats, from row `first` on. False if the values
/// are texts. Networks compute in float, so values of all types are converted.
bool append_rows(const NpyArray& array, std::size_t rows, std::size_t first, std::size_t count,
                 std::vector<float>& out) {
  if (array.header.kind == 'U') return false;
  const std::size_t row = rows == 0 ? 0 : array.header.values() / rows;
  for (std::size_t i = first * row; i < (first + count) * row; ++i) {
    out.push_back(static_cast<float>(number_at(array, i)));
  }
  return true;
}

Result<std::vector<std::int64_t>> integers(const Arrays& arrays, const std::string& key,
                                           const std::string& name) {
  const auto found = arrays.find(key);
  if (found == arrays.end()) return refuse(name, "an array " + key, "none");
  const NpyArray& array = found->second;
  if (array.header.kind != 'i' && array.header.kind != 'u') {
    return refuse(name, key + " of integers", "values of another type");
  }
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < array.header.values(); ++i) out.push_back(integer_at(array, i));
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
    return refuse(name, "a manifest of schema kinalign.windows/1", "another schema");
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
    return refuse(name, "a complete manifest", shown(fault.what()));
  }
  return out;
}

/// For each window: take, part, number of rows, and stamp of its first row.
struct Places {
  std::vector<std::int64_t> take, part, rows, time_ns;
};

/// True if the array `key` has one row of the stream for each row of a window: [N,T,...].
bool is_of_rows(const std::string& key, const std::string& stream, const NpyArray& array) {
  return key.starts_with(stream + "_") && array.header.shape.size() > 2 &&
         !key.ends_with("_rest_offsets");
}

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
      const std::vector<std::uint64_t>& shape = array.header.shape;
      const std::size_t length = shape[1];
      if (piece.skip + piece.rows > length || piece.window >= shape[0]) {
        return refuse(name, key + " with a row for each", "fewer");
      }
      if (!append_rows(array, shape[0] * length, piece.window * length + piece.skip, piece.rows,
                       stretch.streams[stream].arrays[key.substr(stream.size() + 1)])) {
        return refuse(name, key + " of numbers", "texts");
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
      return refuse(name, "rows of a window", std::to_string(rows));
    }
    const bool same_take = w > 0 && places.take[w] == places.take[w - 1];
    const std::int64_t step = same_take ? rows_between(places, w, out.facts.rate_hz) : 0;
    begin = same_take ? begin + step : 0;
    if (begin > most_rows || begin < -most_rows) {
      return refuse(name, "stamps of a take", std::to_string(begin) + " rows in it");
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
  // Members are filled one by one, because GCC leaks the earlier members of a braced list if a
  // later member returns early.
  Places out;
  out.take = KA_TRY(integers(arrays, "take", name));
  out.part = KA_TRY(integers(arrays, "part", name));
  out.rows = KA_TRY(integers(arrays, "rows", name));
  out.time_ns = KA_TRY(integers(arrays, "time_ns", name));
  const std::size_t count = out.take.size();
  if (out.part.size() == count && out.rows.size() == count && out.time_ns.size() == count) {
    return out;
  }
  return refuse(name, "arrays of one length", "take, part, rows and time_ns differ");
}

}  // namespace

const WindowsFacts::Stream* WindowsFacts::find(const std::string& stream) const {
  return find_named(streams, stream);
}

Result<std::map<std::string, NpyArray>> stored_arrays(std::string_view npz,
                                                      const std::string& name) {
  const Bytes bytes(npz);
  std::map<std::string, NpyArray> out;
  for (const Entry& entry : KA_TRY(entries_of(bytes, name))) {
    if (!bytes.holds(entry.at, local_size) || bytes.number(entry.at, 4) != local_mark) {
      return refuse(name, entry.name + " where the ZIP directory says", "another entry");
    }
    // Name and extra field of the local header may be longer than those of the directory.
    const std::size_t begin =
        entry.at + local_size + bytes.number(entry.at + 26, 2) + bytes.number(entry.at + 28, 2);
    if (!bytes.holds(begin, entry.size)) {
      return refuse(name, "all of " + entry.name, "the end of the file");
    }
    const std::string key = entry.name.substr(0, entry.name.rfind(".npy"));
    out[key] = KA_TRY(read_npy(bytes.piece(begin, entry.size), name + ": " + entry.name));
  }
  return out;
}

Result<Windows> read_windows(std::string_view npz, const std::string& name) {
  const auto arrays = KA_TRY(stored_arrays(npz, name));
  const auto manifest = arrays.find("manifest");
  const bool is_text = manifest != arrays.end() && manifest->second.header.kind == 'U' &&
                       manifest->second.header.values() == 1;
  if (!is_text) {
    return refuse(name, "a file of kinalign dataset windows", "no array manifest");
  }
  Windows out;
  out.facts = KA_TRY(read_facts(text_at(manifest->second, 0), name));
  const Places places = KA_TRY(places_of(arrays, name));
  KA_TRY(join(arrays, places, out, name));
  for (const auto& [key, array] : arrays) {
    const std::size_t at = key.rfind("_rest_offsets");
    // Rest offsets have a row for each take, not for each window, so join() leaves them out.
    if (at == std::string::npos || array.header.shape.empty()) continue;
    const std::size_t takes = array.header.shape[0];
    append_rows(array, takes, 0, takes, out.rest_offsets[key.substr(0, at)]);
  }
  return out;
}

}  // namespace kinalign
