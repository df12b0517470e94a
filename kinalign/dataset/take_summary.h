// SPDX-License-Identifier: Apache-2.0
// The facts of a take that are known without opening it: the JSON file next to it
// (docs/formats/dataset.md), schema kinalign.take_summary/1. Everything in it follows from the
// take's bytes.
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

/// The kinds by which the paper counts frames (tables 6 and 7).
enum class Modality : std::uint8_t { mocap, kinect, imu };
inline constexpr std::array<std::string_view, 3> modality_names{"mocap", "kinect", "imu"};

/// A group of the take.
struct StreamSummary {
  std::string name;
  Modality modality = Modality::mocap;  // mocap: the reference and skeletons; kinect: other points;
                                        // imu: nodes
  std::uint64_t columns = 0;            // joints or nodes
  double valid = 1.0, inferred = 0.0;   // shares of rows x columns
  std::uint64_t gaps = 0;
  double gap_s = 0.0;                       // sum of their lengths
  std::optional<std::int64_t> interval_ns;  // the widest half-width; absent: not known
  std::vector<std::string> nodes;           // for nodes: their places
};

/// One take in the index: all that lists, splits and reports need. It is written when the take is
/// made or added.
struct TakeSummary {
  std::string subject, action;  // the take's own
  std::uint64_t frames = 0;     // rows
  double rate_hz = 0.0;
  std::int64_t begin_ns = 0, end_ns = 0;  // first and last row, UTC
  std::vector<StreamSummary> streams;
  std::optional<double> residual_m;  // rms after moving, of the worst stream that was moved
  Quality quality = Quality::good;   // the worst stream's (align/verdict.h), as on the take's page
  std::string worst;                 // the reason in words if it is not good: "kinect: 9 % of ..."
  std::uint64_t errors = 0, warnings = 0;  // findings
  std::string software;                    // the program that made the take: "kinalign 0.1.0"
  std::string recipe;                      // SHA-256 of all parameters: recipe_of()
  std::vector<InputFacts> inputs;          // in the order of the streams
  std::set<std::string> sample_files;      // names of the inputs that contain samples
  std::string sha256;                      // the take file's
  std::uint64_t bytes = 0;                 // size of the take's file

  std::string_view verdict() const { return to_string(quality); }
  double seconds() const { return rate_hz > 0.0 ? static_cast<double>(frames) / rate_hz : 0.0; }
  bool has(Modality modality) const;
};

/// The SHA-256 of everything that makes a take except the bytes of its inputs.
std::string recipe_of(const Manifest& manifest);

/// `report_json`: of the take, see report_json.h. Hash, length and software are left empty.
Result<TakeSummary> summary_of(const TakeHeader& header, std::string_view report_json);

/// The text of the file next to the take.
std::string summary_json(const TakeSummary& summary);
/// Parses the text of summary_json(). `file` appears in messages. Unknown keys are ignored.
Result<TakeSummary> parse_summary_json(std::string_view json, const std::string& file);

}  // namespace kinalign
