// SPDX-License-Identifier: Apache-2.0
// A small sound file of every text format, for rules that hold for all of them.
#pragma once

#include "tests/formats/reading.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/imu/opensim_sto.h"
#include "kinalign/formats/imu/xsens_text.h"
#include "kinalign/formats/points/ntu_skeleton.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/points/ui_prmd_kinect.h"
#include "kinalign/formats/table/table_reader.h"
#include "kinalign/formats/take/take_layout.h"

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Sizes of the pieces that a text is fed in, one after the other.
using PieceSize = std::function<std::size_t()>;

/// The result of reading a file, in words and bytes that can be compared.
struct Outcome {
  std::string error;                  // empty: none
  std::vector<std::string> findings;  // their texts
  std::vector<std::string> rows;      // each row's stamp and values, as bytes
  bool sound = true;                  // shapes fit, numbers are finite, stamps inside +-4e18 ns
};

struct TextFormat {
  std::string file;  // the beginning of the file's names in messages
  std::string text;
  std::function<Outcome(std::string_view text, const PieceSize& piece)> read;
};

namespace text_formats {

/// Collects the arrays of rows, and checks that they have the properties that readers promise.
class Rows {
 public:
  explicit Rows(const std::vector<Time>& stamps) : bytes_(stamps.size()) {
    add(stamps);
    for (const Time stamp : stamps)
      sound = sound && std::abs(to_ns(stamp)) <= 4'000'000'000 * 1'000'000'000LL;
  }

  template <class Value>
  void add(const std::vector<Value>& values) {
    if (bytes_.empty() || values.size() % bytes_.size() != 0) {
      sound = sound && values.empty();
      return;
    }
    const std::size_t width = values.size() / bytes_.size();
    for (std::size_t row = 0; row < bytes_.size(); ++row) {
      bytes_[row] += bytes_of(std::span(values).subspan(row * width, width));
    }
    if constexpr (std::is_same_v<Value, double>) {
      for (const double value : values) sound = sound && std::isfinite(value);
    }
  }

  std::vector<std::string> bytes() const { return bytes_; }
  bool sound = true;

 private:
  std::vector<std::string> bytes_;
};

inline Rows rows_of(const ClipFrames& frames) {
  Rows out(frames.stamps);
  out.add(frames.local_positions);
  out.add(frames.local_rotations);
  return out;
}

inline Rows rows_of(const PointFrames& frames) {
  Rows out(frames.stamps);
  out.add(frames.positions);
  out.add(frames.state);
  return out;
}

inline Rows rows_of(const ImuSamples& samples) {
  Rows out(samples.stamps);
  out.add(samples.orientation);
  out.add(samples.acceleration);
  out.add(samples.angular_velocity);
  out.add(samples.valid);
  return out;
}

template <class ReaderType>
Outcome outcome(std::unique_ptr<ReaderType> reader, std::string_view text, const PieceSize& piece) {
  typename ReaderType::Frames frames;
  Result<void> result;
  while (!text.empty() && result) {
    const std::size_t size = std::min(std::max<std::size_t>(piece(), 1), text.size());
    result = reader->feed(text.substr(0, size), frames);
    text.remove_prefix(size);
  }
  if (result) result = reader->finish(frames);
  Outcome out;
  if (!result) out.error = to_string(result.error());
  for (const Finding& finding : reader->findings) out.findings.push_back(text_of(finding));
  const Rows rows = rows_of(frames);
  out.rows = rows.bytes();
  out.sound = rows.sound;
  return out;
}

template <class MakeReader>
TextFormat format(std::string file, std::string text, MakeReader make) {
  return {std::move(file), std::move(text), [make](std::string_view given, const PieceSize& piece) {
            return outcome(make(), given, piece);
          }};
}

inline std::string kinect_body(int x) {
  std::string text = "72057594037931101 0 1 1 1 0 0 0.1 -0.2 2\n25\n";
  for (int j = 0; j < 25; ++j) text += std::to_string(x + j) + ".5 1 2 0 0 0 0 0 0 0 0 2\n";
  return text;
}

inline std::string numbers_of_ui_prmd(int first) {
  std::string text = std::to_string(first);
  for (int i = 1; i < 66; ++i) text += "," + std::to_string((i * 7 + first) % 50) + ".25";
  return text + "\n";
}

inline TextFormat ui_prmd() {
  const std::string angles = numbers_of_ui_prmd(30) + numbers_of_ui_prmd(60);
  return format("p", numbers_of_ui_prmd(1) + numbers_of_ui_prmd(2), [angles] {
    const TextPieces pieces = [angles, given = false]() mutable -> Result<std::string_view> {
      if (given) return std::string_view();
      given = true;
      return std::string_view(angles);
    };
    return make_ui_prmd_kinect_reader({}, "p.txt", "p_angles.txt", pieces);
  });
}

inline TextFormat bvh() {
  return format("a.bvh",
                "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 90 0\n\tCHANNELS 6 Xposition Yposition "
                "Zposition Zrotation Xrotation Yrotation\n\tJOINT Spine\n\t{\n\t\tOFFSET 0 10 0\n"
                "\t\tCHANNELS 3 Yrotation Xrotation Zrotation\n\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 "
                "10 0\n\t\t}\n\t}\n}\nMOTION\nFrames: 3\nFrame Time: 0.0166667\n"
                "1.5 90 0.25 10 -20 30 1 2 3\n2.5 91 0.25 11 -21 31 4 5 6\n3.5 92 0 9 8 7 6 5 4\n",
                [] { return make_bvh_reader({}, "a.bvh"); });
}

inline TextFormat kinect_table() {
  return format("k.csv",
                "t,A_x,A_y,A_z,A_s,B_x,B_y,B_z,B_s\n10,1,2,3,2,4,5,6,1\n20.5,1.5,2,3,2,,,,0\n"
                "30,1,2.25,3,1,4,5,-6,2\n",
                [] {
                  return make_point_table_reader(
                      layout_of("name = 'two'\n[time]\ncolumn = 't'\nunit = 'ms'\n[joints]\n"
                                "names = ['A', 'B']\nfields = { x = '{joint}_x', y = '{joint}_y', "
                                "z = '{joint}_z', state = '{joint}_s' }\n"),
                      {}, "k.csv");
                });
}

inline TextFormat node_table() {
  return format("w.csv",
                "time_ns,qw,qx,qy,qz,ax,ay,az,gx,gy,gz\n1000,1,0,0,0,1,2,9.5,0.1,0.2,0.3\n"
                "2000,0.5,0.5,0.5,0.5,1,2,9.75,0.1,0.2,-0.3\n3000,0,0,0,1,,2,9,0,0,0\n",
                [] { return make_imu_table_reader(builtin("imu"), {}, "w.csv", "waist"); });
}

inline TextFormat trc() {
  return format("m.trc",
                "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\t"
                "Units\n100\t100\t3\t2\tmm\nFrame#\tTime\tHEAD\t\t\tTOE\t\t\n\t\tX1\tY1\tZ1\tX2\t"
                "Y2\tZ2\n\n1\t0\t1\t2\t3\t4\t5\t6\n2\t0.01\t1.5\t2\t3\t\t\t\n3\t0.02\t1\t2\t3\t4"
                "\t5\t-6.5\n",
                [] { return make_trc_reader({}, "m.trc"); });
}

inline TextFormat xsens() {
  return format("x.txt",
                "// Start Time: 3\n// Update Rate: 100.0Hz\nPacketCounter;Acc_X;Acc_Y;Acc_Z;Roll;"
                "Pitch;Yaw\n00007;1;2;9.5;10;20;30\n00008;1;2;9.25;-10;20;30.5\n00009;1;2;9;;;\n",
                [] { return make_xsens_text_reader({}, "x.txt", "waist"); });
}

inline TextFormat sto() {
  return format("o.sto",
                "DataRate=100\nDataType=Quaternion\nversion=3\nendheader\ntime\ta_imu\tb_imu\n"
                "1\t1,0,0,0\t0.5,0.5,0.5,0.5\n1.01\t0,0,1,0\tnan\n1.02\t1,0,0,0\t0,0,0,1\n",
                [] { return make_opensim_sto_reader({}, "o.sto"); });
}

inline TextFormat ntu() {
  return format("n.skeleton", "3\n1\n" + kinect_body(1) + "0\n1\n" + kinect_body(2),
                [] { return make_ntu_skeleton_reader({}, "n.skeleton"); });
}

}  // namespace text_formats

inline std::vector<TextFormat> all_text_formats() {
  using namespace text_formats;
  return {bvh(), kinect_table(), node_table(), trc(), xsens(), sto(), ntu(), ui_prmd()};
}

/// Read at once.
inline Outcome read_whole(const TextFormat& format, std::string_view text) {
  return format.read(text, [] { return SIZE_MAX; });
}

}  // namespace kinalign
