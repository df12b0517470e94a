// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/dataset_page/skeleton_svg.h"

#include "tests/seeds.h"

#include "kinalign/motion/streams.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

/// Hips, head, left hand, right hand: a cross of 1 m by 1.5 m.
PageBody cross(double turned_rad = 0.0) {
  PageBody body;
  body.parents = {-1, 0, 1, 1};
  for (const Vec3& p :
       {Vec3(0, 0.5, 0), Vec3(0, 1.5, 0), Vec3(0.75, 1.4, 0), Vec3(-0.75, 1.4, 0)}) {
    const double x = p.x() * std::cos(turned_rad), z = -p.x() * std::sin(turned_rad);
    for (const double v : {x, p.y(), z}) body.positions.push_back(static_cast<float>(v));
  }
  body.state.assign(4, static_cast<std::uint8_t>(Tracking::tracked));
  return body;
}

}  // namespace

TEST_CASE("a picture has the bones of each body in its colour") {
  PageBody kinect = cross();
  kinect.colour = PageColour::kinect;
  const std::string svg = skeleton_svg({cross(), kinect});
  CHECK(svg ==
        "<svg viewBox=\"0 0 120 160\"><path class=\"mocap\" d=\"M60 154L60 82L114 89M60 82L6 "
        "89\"/><path class=\"kinect\" d=\"M60 154L60 82L114 89M60 82L6 89\"/></svg>");
}

TEST_CASE("a bone with an inferred end is dashed, one with a missing end is not drawn") {
  PageBody body = cross();
  body.state[2] = static_cast<std::uint8_t>(Tracking::inferred);
  body.state[3] = static_cast<std::uint8_t>(Tracking::missing);
  const std::string svg = skeleton_svg({body});
  CHECK(svg.find("class=\"mocap dashed\"") != std::string::npos);
  CHECK(svg.find("class=\"mocap\"") != std::string::npos);
  body.state[0] = body.state[2] = static_cast<std::uint8_t>(Tracking::missing);
  CHECK(skeleton_svg({body}).empty());
}

TEST_CASE(
    "markers, which have no bones, are dots, pale where inferred, and the picture holds them") {
  PageBody markers = cross();
  markers.parents.assign(4, -1);
  markers.state[3] = static_cast<std::uint8_t>(Tracking::inferred);
  CHECK(skeleton_svg({markers}) ==
        "<svg viewBox=\"0 0 120 160\"><path class=\"mocap dots\" d=\"M60 154h0M60 82h0M114 "
        "89h0\"/><path class=\"mocap dots pale\" d=\"M6 89h0\"/></svg>");
  markers.state[0] = static_cast<std::uint8_t>(Tracking::missing);
  markers.positions[6] = std::numeric_limits<float>::infinity();
  const std::string two = skeleton_svg({markers});
  CHECK(two.find("M60 154h0") == std::string::npos);
  const bool only_two = two.find("h0M") == std::string::npos;  // one tracked, one inferred
  CHECK(only_two);
}

TEST_CASE("a joint on a bone is no dot, and markers count for the side from which a pose is seen") {
  PageBody some = cross();
  some.parents[3] = -1;
  CHECK(skeleton_svg({some}) ==
        "<svg viewBox=\"0 0 120 160\"><path class=\"mocap\" d=\"M60 154L60 82L114 89\"/><path "
        "class=\"mocap dots\" d=\"M6 89h0\"/></svg>");
  PageBody turned = cross(1.5707963);  // along z
  turned.parents.assign(4, -1);
  CHECK(skeleton_svg({turned}).find("M6 89h0") != std::string::npos);
}

TEST_CASE("what is not in the take's space, and numbers out of this world, are not drawn") {
  PageBody own = cross();
  own.in_take_space = false;
  CHECK(skeleton_svg({own}).empty());
  CHECK(skeleton_svg({}).empty());
  for (const float odd :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    PageBody body = cross();
    body.positions[6] = odd;
    CHECK(skeleton_svg({body}) ==
          "<svg viewBox=\"0 0 120 160\"><path class=\"mocap\" d=\"M94 154L94 64L26 73\"/></svg>");
  }
}

TEST_CASE("a pose is seen from the side from which it is widest, whichever way the person faces") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    const double turned = 1e-3 * static_cast<double>(seed % 6283);
    const std::string svg = skeleton_svg({cross(turned)});
    const bool same = svg == skeleton_svg({cross()}) ||  // or its mirror image, seen from behind
                      svg.find("M60 154L60 82L6 89M60 82L114 89") != std::string::npos;
    CHECK(same);
  }
}
