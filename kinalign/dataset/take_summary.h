// SPDX-License-Identifier: Apache-2.0
// The facts of a take that are known without opening it, stored in a JSON file beside the take
// (docs/formats/dataset.md), schema kinalign.take_summary/1. All of them follow from the take's
// bytes.
#pragma once

#include "kinalign/align/verdict.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/take/take.h"

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The kinds of data for which the HFUT-MMD paper (README.md) counts frames, in its tables 6 and 7.
enum class Modality : std::uint8_t { mocap, kinect, imu };
inline constexpr std::array<std::string_view, 3> modality_names{"mocap", "kinect", "imu"};

/// The facts of one group of the take.
struct StreamSummary {
  std::string name;
  Modality modality = Modality::mocap;  // mocap: the reference and skeletons; kinect: other points;
                                        // imu: nodes
  std::uint64_t columns = 0;            // joints or nodes
  double valid = 1.0, inferred = 0.0;   // shares of rows x columns
  std::uint64_t gaps = 0;
  double gap_s = 0.0;                       // sum of the lengths of all gaps
  std::optional<std::int64_t> interval_ns;  // largest half-width of intervals; absent: not known
  std::vector<std::string> nodes;           // for a group of nodes: the places where they are worn
};

/// The facts of one take for lists, splits and reports. They are written when the take is made or
/// added.
struct TakeSummary {
  std::string subject, action;  // as stated in the take
  std::uint64_t frames = 0;     // rows
  double rate_hz = 0.0;
  std::int64_t begin_ns = 0, end_ns = 0;  // first and last row, UTC
  std::vector<StreamSummary> streams;
  std::optional<double> residual_m;  // rms after moving, m, of the worst stream that was moved
  Quality quality = Quality::good;   // that of the worst stream (align/verdict.h)
  std::string worst;  // the reason in words if the quality is not good: "kinect: 9 % of ..."
  std::uint64_t errors = 0, warnings = 0;  // numbers of findings
  std::string software;                    // the program that made the take: "kinalign 0.1.0"
  std::string recipe;                      // SHA-256 of all parameters: recipe_of()
  std::vector<InputFacts> inputs;          // in the order of the streams
  std::set<std::string> sample_files;      // names of the inputs that contain samples
  std::string sha256;                      // of the take's file
  std::uint64_t bytes = 0;                 // size of the take's file

  std::string_view verdict() const { return to_string(quality); }
  double seconds() const { return rate_hz > 0.0 ? static_cast<double>(frames) / rate_hz : 0.0; }
  bool has(Modality modality) const;
};

/// The SHA-256 of everything that decides a take except the bytes of its inputs.
std::string recipe_of(const Manifest& manifest);

/// `report_json`: the take's report (report_json.h). Hash, size and software are left empty.
Result<TakeSummary> summary_of(const TakeHeader& header, std::string_view report_json);

/// The text of the summary's file.
std::string summary_json(const TakeSummary& summary);
/// Parses the text of summary_json(). `file` appears in messages. Unknown keys are ignored.
Result<TakeSummary> parse_summary_json(std::string_view json, const std::string& file);

}  // namespace kinalign
