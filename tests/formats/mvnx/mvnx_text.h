// SPDX-License-Identifier: Apache-2.0
// Small MVNX documents: a pelvis and a leg 1 m below it.
#pragma once

#include <string>

namespace kinalign {

/// One element of a frame.
inline std::string element(const std::string& name, const std::string& numbers) {
  return "<" + name + ">" + numbers + "</" + name + ">\n";
}

inline std::string frame(const std::string& attributes, const std::string& elements) {
  return "<frame " + attributes + ">\n" + elements + "</frame>\n";
}

/// A frame of both segments: upright, the pelvis at (x, 0, 1), the leg's end below it.
inline std::string upright(const std::string& attributes, const std::string& x) {
  return frame(attributes, element("orientation", "1 0 0 0 1 0 0 0") +
                               element("position", x + " 0 1 " + x + " 0.1 0"));
}

inline std::string mvnx_of(const std::string& frames, const std::string& rate = "100",
                           const std::string& points =
                               "<points><point label=\"jHip\"><pos_b>0 0.1 "
                               "-1</pos_b></point></points>") {
  return "<?xml version=\"1.0\"?>\n<mvnx version=\"4\"><mvn version=\"2019\"/>\n"
         "<subject label=\"A\" frameRate=\"" +
         rate +
         "\" segmentCount=\"2\">\n"
         "<segments><segment label=\"Pelvis\" id=\"1\">" +
         points +
         "</segment>\n<segment label=\"Leg\" id=\"2\"><points><point label=\"jHip\"><pos_b>0 0 "
         "0</pos_b></point><point label=\"pFoot\"><pos_b>0.2 0 -0.4</pos_b></point></points>"
         "</segment></segments>\n"
         "<sensors><sensor label=\"Pelvis\"/><sensor label=\"Leg\"/></sensors>\n"
         "<joints><joint label=\"jHip\"><connector1>Pelvis/jHip</connector1>"
         "<connector2>Leg/jHip</connector2></joint></joints>\n"
         "<frames segmentCount=\"2\" sensorCount=\"2\" jointCount=\"1\">\n" +
         frames + "</frames></subject></mvnx>\n";
}

}  // namespace kinalign
