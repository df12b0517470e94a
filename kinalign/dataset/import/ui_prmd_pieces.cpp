// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/ui_prmd_pieces.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/archive/npz.h"

#include <fmt/format.h>

#include <array>

namespace kinalign {

namespace {

constexpr ArchiveLimits largest_pieces{
    .entries = 100, .bytes = std::uint64_t{512} << 20, .ratio = 1000};
constexpr std::size_t kinect_columns = 66, vicon_columns = 117;
/// Decimals of the packed numbers. The Kinect's are in 0.01 cm and 0.01 degrees, the markers' in
/// 0.1 mm.
constexpr int kinect_decimals = 2, vicon_decimals = 1;

/// Values [C,F]. They are packed as differences, taken `times` times; sums wrap around.
struct PackedTable {
  std::vector<std::int16_t> values;
  std::size_t columns = 0, frames = 0;
  double scale = 1.0;
  int decimals = 0;
};

/// The name of an array in the pack, and how its numbers were packed.
struct Packing {
  const char* array;
  std::size_t columns;
  int times, decimals;
};

/// Sums up the differences, column by column.
Result<PackedTable> read_table(const Npz& npz, const Packing& packing) {
  const auto steps = KA_TRY(npz.integers(packing.array, {packing.columns, 0}));
  PackedTable out{{}, packing.columns, steps.size() / packing.columns, 1.0, packing.decimals};
  for (int i = 0; i < packing.decimals; ++i) out.scale *= 10.0;
  out.values.reserve(steps.size());
  for (std::size_t c = 0; c < out.columns; ++c) {
    // For each time that differences were taken, there is one running sum.
    std::array<std::uint16_t, 2> sums{};
    for (std::size_t f = 0; f < out.frames; ++f) {
      // Unsigned numbers wrap around in a defined way.
      auto value = static_cast<std::uint16_t>(steps[c * out.frames + f]);
      for (int k = 0; k < packing.times; ++k) {
        auto& sum = sums[static_cast<std::size_t>(k)];
        value = sum = static_cast<std::uint16_t>(sum + value);
      }
      out.values.push_back(static_cast<std::int16_t>(value));
    }
  }
  return out;
}

/// The text form of some rows, as in the source: numbers between commas.
std::string text_of(const PackedTable& table, std::size_t begin, std::size_t rows) {
  std::string out;
  // The digits do not depend on the locale.
  std::array<char, number_room> room{};
  for (std::size_t f = begin; f < begin + rows; ++f) {
    for (std::size_t c = 0; c < table.columns; ++c) {
      const double value = table.values[c * table.frames + f] / table.scale;
      if (c > 0) out += ',';
      out.append(room.data(), put_number(room.data(), value, table.decimals));
    }
    out += '\n';
  }
  return out;
}

/// A row of the pack's index: where a repetition begins in the arrays, and its number of rows.
struct Piece {
  std::int64_t movement, repetition, kinect_begin, kinect_rows, vicon_begin, vicon_rows;
};

/// True if the rows exist in the table. It is written so that no sum can overflow.
bool lies_in(std::int64_t begin, std::int64_t rows, const PackedTable& table) {
  const auto all = static_cast<std::int64_t>(table.frames);
  return begin >= 0 && begin <= all && rows >= 0 && rows <= all - begin;
}

Result<void> write_text(const PutFile& put, const std::string& name, const PackedTable& table,
                        std::int64_t begin, std::int64_t rows) {
  OutputFile out = KA_TRY(put(name));
  KA_TRY(
      out.write(text_of(table, static_cast<std::size_t>(begin), static_cast<std::size_t>(rows))));
  return out.commit();
}

/// All numbers of one person: positions and angles of the Kinect, and markers.
struct Tables {
  PackedTable offsets, angles, markers;
};

/// Checks a row of the index. A damaged row could lead outside of the arrays or to bad file names.
Result<void> check_piece(const Piece& p, const Tables& tables, const std::string& file) {
  const bool fits = p.movement >= 0 && p.movement < 100 && p.repetition >= 0 &&
                    p.repetition < 100 && lies_in(p.kinect_begin, p.kinect_rows, tables.offsets) &&
                    lies_in(p.kinect_begin, p.kinect_rows, tables.angles) &&
                    lies_in(p.vicon_begin, p.vicon_rows, tables.markers);
  if (fits) return {};
  return Failure(Error{file, 0, "pieces within the arrays",
                       fmt::format("piece {} of movement {}", p.repetition, p.movement)});
}

/// Writes the text files of a repetition. A device without rows gets no file.
Result<void> write_piece(const Piece& p, const Tables& tables, const std::string& person,
                         const PutFile& put) {
  const std::string name = fmt::format("m{:02}_{}_e{:02}", p.movement, person, p.repetition);
  if (p.kinect_rows > 0) {
    KA_TRY(write_text(put, "Kinect/Positions/" + name + "_positions.txt", tables.offsets,
                      p.kinect_begin, p.kinect_rows));
    KA_TRY(write_text(put, "Kinect/Angles/" + name + "_angles.txt", tables.angles, p.kinect_begin,
                      p.kinect_rows));
  }
  if (p.vicon_rows == 0) return {};
  return write_text(put, "Vicon/Positions/" + name + "_positions.txt", tables.markers,
                    p.vicon_begin, p.vicon_rows);
}

}  // namespace

Result<void> write_ui_prmd_pieces(const ArchiveBytes& bytes, const std::string& person,
                                  const PutFile& put) {
  const Npz npz = KA_TRY(Npz::read(bytes, largest_pieces));
  // The index has six numbers for each repetition, in the order of Piece.
  const auto index = KA_TRY(npz.integers("index", {0, 6}));
  const Tables tables{KA_TRY(read_table(npz, {"kinect_local", kinect_columns, 1, kinect_decimals})),
                      KA_TRY(read_table(npz, {"kinect_euler", kinect_columns, 1, kinect_decimals})),
                      KA_TRY(read_table(npz, {"vicon_markers", vicon_columns, 2, vicon_decimals}))};
  for (std::size_t i = 0; i + 6 <= index.size(); i += 6) {
    const Piece piece{index[i],     index[i + 1], index[i + 2],
                      index[i + 3], index[i + 4], index[i + 5]};
    // A wrong row stops the import before any of its files is written.
    KA_TRY(check_piece(piece, tables, bytes.name));
    KA_TRY(write_piece(piece, tables, person, put));
  }
  return {};
}

}  // namespace kinalign
