// SPDX-License-Identifier: Apache-2.0
// The content of a benchmark's page as plain data: the paper's tables 8 and 9 and figures 8 to 10.
// apps/kinalign/benchmark fills it in; models_html.h makes the page. Metres, y up.
#pragma once

#include "kinalign/view/table.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Colours: truth and mocap red, a Kinect green, nodes blue. An answer to a Kinect has the colour
/// of the text, an answer to both devices a colour of its own.
enum class FigureColour { truth, kinect, imu, method, both };

/// A skeleton of J joints at one instant.
struct StickFigure {
  FigureColour colour = FigureColour::method;
  bool is_pale = false;              // drawn faintly, behind the others
  std::vector<float> positions;      // [J,3] m
  std::vector<int> parents;          // [J] the joint at the other end of the bone; -1: none
  std::vector<std::uint8_t> states;  // [J] as Tracking; empty: all tracked
};

/// One picture: several figures in one drawing, and a line below it.
struct PosePicture {
  std::vector<StickFigure> figures;  // none: there is no picture
  std::string below;                 // "4.2 cm"
};

/// Pictures in rows and columns, all in one scale and from one direction.
/// Each row has as many pictures as there are columns.
struct PosePictures {
  std::string id, title, caption;
  std::vector<std::pair<std::string, std::string>> columns;  // title, and the take and time
  /// Name, and a picture for each column.
  std::vector<std::pair<std::string, std::vector<PosePicture>>> rows;
  std::vector<Table> tables;  // below the pictures
  std::string absent;         // the missing parts with the reason; else empty
};

/// The error of one method over time.
struct ErrorCurve {
  std::string method;
  std::vector<float> cm;  // [K]
};

/// All curves begin at the take's start.
struct ErrorPlot {
  std::string caption;
  float step_s = 0.5F;  // value k is for the time from k to k + 1 steps
  std::vector<ErrorCurve> curves;
};

/// A body that moves, over T rows.
struct MovingBody {
  std::string name;
  FigureColour colour = FigureColour::method;
  std::vector<int> parents;          // [J] as in StickFigure
  std::vector<float> positions;      // [T,J,3] m
  std::vector<std::uint8_t> states;  // [T,J] as Tracking; empty: all tracked
  std::vector<float> cm;             // [T] mean distance to the truth; empty: not shown
};

/// A part of a take with the answers of all methods, shown moving.
/// All bodies have the same T rows, so one clock moves them.
struct SideBySide {
  std::string caption;
  double rate_hz = 30.0;
  std::vector<MovingBody> bodies;  // the truth first; empty: nothing is shown
};

/// Sections in the order of the page. An empty part is left out.
struct ModelsPage {
  std::string name, software;
  std::string headline;                                      // the result in a sentence
  std::vector<std::string> facts;                            // "5 takes of 3 people"
  std::vector<std::pair<std::string, std::string>> numbers;  // "3.4 cm", "refine, steadied"
  Table marks;                                               // table 9
  std::string marks_note;
  PosePictures poses;  // table 8
  ErrorPlot errors;
  SideBySide motion;
  std::vector<PosePictures> figures;  // figures 8, 9 and 10
  std::string command;                // the command that makes the page again
};

}  // namespace kinalign
