// SPDX-License-Identifier: Apache-2.0
// The content of a benchmark's page as plain data: tables 8 and 9 and figures 8 to 10 of the
// HFUT-MMD paper. apps/kinalign/benchmark fills it; models_html.h makes the page. Metres, y up.
#pragma once

#include "kinalign/view/table.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Colours: truth and mocap red, Kinect green, nodes blue. The result of a method for the Kinect
/// has the colour of text; the result for Kinect and nodes has another colour.
enum class FigureColour { truth, kinect, imu, method, both };

/// A skeleton of J joints at one moment.
struct StickFigure {
  FigureColour colour = FigureColour::method;
  bool is_pale = false;              // drawn faintly, in the background
  std::vector<float> positions;      // [J,3] m
  std::vector<int> parents;          // [J] joint at the other end of the bone; -1: none
  std::vector<std::uint8_t> states;  // [J] values of Tracking; empty: all tracked
};

/// One picture: several figures in one drawing, and a line of text below.
struct PosePicture {
  std::vector<StickFigure> figures;  // empty: no picture
  std::string below;                 // such as "4.2 cm"
};

/// Pictures in rows and columns, all with the same scale and viewing direction. Each row has as
/// many pictures as there are columns.
struct PosePictures {
  std::string id, title, caption;
  std::vector<std::pair<std::string, std::string>> columns;  // title; take and time
  /// Name of the row, and a picture for each column.
  std::vector<std::pair<std::string, std::vector<PosePicture>>> rows;
  std::vector<Table> tables;  // tables below the pictures
  std::string absent;         // which parts are missing and why; otherwise empty
};

/// The error of one method over time.
struct ErrorCurve {
  std::string method;
  std::vector<float> cm;  // [K]
};

/// The errors of all methods over time. All curves begin at the start of the take.
struct ErrorPlot {
  std::string caption;
  float step_s = 0.5F;  // value k covers the time from k to k + 1 steps
  std::vector<ErrorCurve> curves;
};

/// A body that moves, over T rows.
struct MovingBody {
  std::string name;
  FigureColour colour = FigureColour::method;
  std::vector<int> parents;          // [J] as in StickFigure
  std::vector<float> positions;      // [T,J,3] m
  std::vector<std::uint8_t> states;  // [T,J] values of Tracking; empty: all tracked
  std::vector<float> cm;             // [T] mean distance to the truth; empty: not displayed
};

/// A part of a take with the results of all methods, which the page shows as moving bodies. All
/// bodies have the same T rows.
struct SideBySide {
  std::string caption;
  double rate_hz = 30.0;
  std::vector<MovingBody> bodies;  // the truth is first; empty: nothing is shown
};

/// The sections in the order of the page. Empty sections are omitted.
struct ModelsPage {
  std::string name, software;
  std::string headline;                                      // the result in one sentence
  std::vector<std::string> facts;                            // such as "5 takes of 3 people"
  std::vector<std::pair<std::string, std::string>> numbers;  // number ("3.4 cm") and its meaning
  Table marks;                                               // table 9 of the paper
  std::string marks_note;
  PosePictures poses;  // table 8 of the paper
  ErrorPlot errors;
  SideBySide motion;
  std::vector<PosePictures> figures;  // figures 8 to 10 of the paper
  std::string command;                // command that makes the page again
};

}  // namespace kinalign
