// SPDX-License-Identifier: Apache-2.0
// All that the page of a benchmark shows, as plain data: the paper's tables 8 and 9 and figures 8
// to 10. apps/kinalign/benchmark fills it in; models_html.h makes the page. Metres, y up.
#pragma once

#include "kinalign/view/table.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Truth and mocap are red, a Kinect green, nodes blue; an answer to a Kinect has the colour of the
/// text, one to both devices its own.
enum class FigureColour { truth, kinect, imu, method, both };

/// A skeleton of J joints at one instant.
struct StickFigure {
  FigureColour colour = FigureColour::method;
  bool is_pale = false;              // drawn faintly, behind the others
  std::vector<float> positions;      // [J,3] m
  std::vector<int> parents;          // [J] the joint that a bone leads from; -1: none
  std::vector<std::uint8_t> states;  // [J] as Tracking; empty: all are tracked
};

/// One picture: figures over each other, and a line below it.
struct PosePicture {
  std::vector<StickFigure> figures;  // none: there is no picture
  std::string below;                 // "4.2 cm"
};

/// Pictures in rows and columns, all of one scale and from one direction.
struct PosePictures {
  std::string id, title, caption;
  std::vector<std::pair<std::string, std::string>> columns;  // what it shows, and where that is
  std::vector<std::pair<std::string, std::vector<PosePicture>>> rows;  // as many as the columns
  std::vector<Table> tables;                                           // below the pictures
  std::string absent;  // what could not be shown, and why; else empty
};

/// The error of one method over time.
struct ErrorCurve {
  std::string method;
  std::vector<float> cm;  // [K]
};

struct ErrorPlot {
  std::string caption;
  float step_s = 0.5F;  // the value k stands for the time from k to k + 1 steps
  std::vector<ErrorCurve> curves;
};

/// A body that moves over T rows.
struct MovingBody {
  std::string name;
  FigureColour colour = FigureColour::method;
  std::vector<int> parents;          // [J] as of StickFigure
  std::vector<float> positions;      // [T,J,3] m
  std::vector<std::uint8_t> states;  // [T,J] as Tracking; empty: all are tracked
  std::vector<float> cm;             // [T] mean distance to the truth; empty: not shown
};

/// A stretch of a take that all methods answer to, shown moving.
struct SideBySide {
  std::string caption;
  double rate_hz = 30.0;
  std::vector<MovingBody> bodies;  // the truth first; none: nothing is shown
};

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
  std::string command;                // that made the page
};

}  // namespace kinalign
