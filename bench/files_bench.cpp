// SPDX-License-Identifier: Apache-2.0
// Whole files: a BVH and a CSV read with all checks against a std::from_chars loop over the same
// text in memory, and a take written against write() of the same bytes to a new file.
#include "kinalign/formats/bvh/head.h"
#include "kinalign/formats/bvh/rows.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/formats/table/table_reader.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/formats/take/take_layout.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

using namespace kinalign;

namespace {

/// A folder for the files of this run.
const std::string& folder() {
  static const std::string name = [] {
    std::string path = (std::filesystem::temp_directory_path() / "kinalign-bench-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) std::abort();
    std::atexit([] { std::filesystem::remove_all(folder()); });
    return path + "/";
  }();
  return name;
}

constexpr std::size_t joints = 59, frames = 4000;

double angle(std::size_t row, std::size_t column) {
  const auto rate = 0.01 + 0.001 * static_cast<double>(column % 37);
  return 60.0 * std::sin(rate * static_cast<double>(row) + static_cast<double>(column));
}

std::string bvh_text() {
  std::string text = "HIERARCHY\n";
  for (std::size_t j = 0; j < joints; ++j) {
    text += fmt::format("{} joint{}\n{{\nOFFSET 0 {} 0\n", j == 0 ? "ROOT" : "JOINT", j, j + 1);
    text += "CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n";
  }
  for (std::size_t j = 0; j < joints; ++j) text += "}\n";
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: 0.0166667\n", frames);
  for (std::size_t r = 0; r < frames; ++r) {
    for (std::size_t c = 0; c < 6 * joints; ++c) text += fmt::format("{:.4f} ", angle(r, c));
    text += '\n';
  }
  return text;
}

std::string csv_text() {
  std::string text = "time_ns";
  const TableLayout layout = *parse_layout(*builtin_layout("kinect"), "kinect");
  for (const auto& name : layout.names) {
    for (const char* field : {"x", "y", "z", "state"}) text += fmt::format(",{}_{}", name, field);
  }
  text += '\n';
  for (std::size_t r = 0; r < 4 * frames; ++r) {
    text += std::to_string(1'790'000'000'000'000'000 + 33'000'000 * r);
    for (std::size_t c = 0; c < 75; ++c) {
      text += fmt::format(",{:.6f}", angle(r, c) / 30.0);
      if (c % 3 == 2) text += ",2";
    }
    text += '\n';
  }
  return text;
}

std::string put(const std::string& name, const std::string& text) {
  PosixFiles files;
  OutputFile file = *OutputFile::create(files, folder() + name, Overwrite::yes);
  if (!file.write(text) || !file.commit()) std::abort();
  return folder() + name;
}

/// Parses every number of a text with std::from_chars, whatever stands between them.
void parse_all(benchmark::State& state, const std::string& text) {
  std::vector<double> out(text.size() / 2 + 1);
  for (auto _ : state) {
    const char *at = text.data(), *end = at + text.size();
    double* to = out.data();
    while (at < end) {
      const auto [behind, fault] = std::from_chars(at, end, *to);
      at = fault == std::errc{} ? behind : at + 1;
      to += fault == std::errc{} ? 1 : 0;
    }
    benchmark::DoNotOptimize(out.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

std::string rows_of(const std::string& text) {
  return text.substr(text.find('\n', text.find("Frame Time:")) + 1);
}

void bvh_from_chars(benchmark::State& state) { parse_all(state, rows_of(bvh_text())); }

void bvh_kinalign(benchmark::State& state) {
  PosixFiles files;
  const std::string text = bvh_text();
  const std::string path = put("bench.bvh", text);
  Findings findings;
  for (auto _ : state) {
    InputFile file = *InputFile::open(files, path);
    std::optional<BvhRows> rows;
    BvhHead head(path);
    for (std::string_view piece = *file.next(); !piece.empty(); piece = *file.next()) {
      if (!rows) {
        if (!*head.add(piece, findings)) continue;
        rows.emplace(BvhRowsHead{path, head.hierarchy.row_size(), head.hierarchy.frames, 1});
        piece = head.rows();
      }
      if (!rows->feed(piece, findings)) std::abort();
      benchmark::DoNotOptimize(rows->frames().data());
      rows->drop_frames();
    }
    if (!rows->finish(findings) || rows->frames_read() != frames) std::abort();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(rows_of(text).size()));
}

void csv_from_chars(benchmark::State& state) { parse_all(state, csv_text()); }

void csv_kinalign(benchmark::State& state) {
  PosixFiles files;
  const std::string text = csv_text();
  const std::string path = put("bench.csv", text);
  const TableLayout layout = *parse_layout(*builtin_layout("kinect"), "kinect");
  PointFrames block;
  for (auto _ : state) {
    InputFile file = *InputFile::open(files, path);
    const auto reader = make_point_table_reader(layout, {}, path);
    for (std::string_view piece = *file.next(); !piece.empty(); piece = *file.next()) {
      block = {};
      if (!reader->feed(piece, block)) std::abort();
      benchmark::DoNotOptimize(block.positions.data());
    }
    if (!reader->finish(block)) std::abort();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

/// Does all file work but waiting for the disk.
class Unsynced final : public PosixFiles {
 public:
  int sync(int) override { return 0; }
};

constexpr std::size_t slab = 2000;
constexpr std::size_t row_bytes(std::size_t number) { return joints * 10 * number + 16; }

/// A take's rows of a 59-joint skeleton.
TakeSlab take_rows() {
  ClipRows rows;
  rows.positions.assign(slab * joints * 3, 0.25);
  rows.local_positions = rows.positions;
  rows.local_rotations.assign(slab * joints * 4, 0.5);
  TakeSlab out;
  out.rows = {rows};
  return out;
}

TakeHeader take_header(std::size_t slabs) {
  Skeleton skeleton;
  for (std::size_t j = 0; j < joints; ++j) {
    skeleton.joint_names.push_back(fmt::format("joint{}", j));
    skeleton.parents.push_back(static_cast<int>(j) - 1);
    skeleton.rest_offsets.emplace_back(0.0, 0.1, 0.0);
  }
  TakeHeader header;
  header.frames = slab * slabs;
  header.groups = {{"mocap", ClipGroup{skeleton}, false, false, {}}};
  return header;
}

/// `state.range(0)` slabs of doubles as a take of floats or of doubles.
template <class Files, Stored stored>
void take_kinalign(benchmark::State& state) {
  Files files;
  const auto slabs = static_cast<std::size_t>(state.range(0));
  TakeHeader header = take_header(slabs);
  header.parameters.align.store_double = stored == Stored::float64;
  TakeSlab rows = take_rows();
  for (auto _ : state) {
    auto writer = *TakeWriter::create(files, folder() + "take.h5", Overwrite::no, header);
    for (std::size_t s = 0; s < slabs; ++s) {
      rows.first = s * slab;
      rows.stamps.clear();
      for (std::size_t r = 0; r < slab; ++r) {
        rows.stamps.push_back(utc_time(static_cast<std::int64_t>((s * slab + r) * 16'666'667)));
      }
      if (!writer.append(rows)) std::abort();
    }
    if (!writer.finish({})) std::abort();
    state.PauseTiming();
    std::filesystem::remove(folder() + "take.h5");
    state.ResumeTiming();
  }
  state.SetBytesProcessed(state.iterations() * state.range(0) *
                          static_cast<std::int64_t>(slab * row_bytes(size_of(stored))));
}

/// The same bytes by write(), with the same sync and rename.
template <class Files>
void take_write(benchmark::State& state) {
  Files files;
  const std::string bytes(slab * row_bytes(sizeof(float)), '\x3f');
  for (auto _ : state) {
    OutputFile file = *OutputFile::create(files, folder() + "take.raw", Overwrite::no);
    for (std::int64_t s = 0; s < state.range(0); ++s) {
      if (!file.write(bytes)) std::abort();
    }
    if (!file.commit()) std::abort();
    state.PauseTiming();
    std::filesystem::remove(folder() + "take.raw");
    state.ResumeTiming();
  }
  state.SetBytesProcessed(state.iterations() * state.range(0) *
                          static_cast<std::int64_t>(bytes.size()));
}

BENCHMARK(bvh_from_chars)->Name("bvh/from_chars");
BENCHMARK(bvh_kinalign)->Name("bvh/kinalign");
BENCHMARK(csv_from_chars)->Name("csv/from_chars");
BENCHMARK(csv_kinalign)->Name("csv/kinalign");
constexpr std::int64_t large = 25, small = 3;  // number of slabs: 118 and 14 MB of floats
constexpr auto floats = Stored::float32, doubles = Stored::float64;
BENCHMARK(take_write<PosixFiles>)->Name("take/write")->Arg(large)->UseRealTime();
BENCHMARK(take_kinalign<PosixFiles, floats>)->Name("take/kinalign")->Arg(large)->UseRealTime();
BENCHMARK(take_write<Unsynced>)->Name("take_unsynced/write")->Arg(small)->UseRealTime();
BENCHMARK(take_kinalign<Unsynced, floats>)
    ->Name("take_unsynced/kinalign")
    ->Arg(small)
    ->UseRealTime();
// 19 MB of doubles, which are not converted to floats.
BENCHMARK(take_write<Unsynced>)->Name("take_doubles/write")->Arg(4)->UseRealTime();
BENCHMARK(take_kinalign<Unsynced, doubles>)->Name("take_doubles/kinalign")->Arg(2)->UseRealTime();

}  // namespace
