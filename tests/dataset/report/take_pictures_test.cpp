// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/report/take_pictures.h"

#include "tests/folder.h"
#include "tests/view/page/page_takes.h"

#include "kinalign/formats/take/take_hdf5.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

void write(const FreshFolder& folder, PosixFiles& files, const TakeName& name,
           const PageTake& take) {
  std::filesystem::create_directories(folder / ("sub-" + name.subject));
  auto writer =
      TakeWriter::create(files, folder / path_of(name, TakeFile::take), Overwrite::no, take.header);
  if (!writer) FAIL(to_string(writer.error()));
  REQUIRE(writer->append(take.slab));
  REQUIRE(writer->finish(take.report));
}

void hide(PageTake& take, std::size_t row) {
  auto& points = std::get<PointRows>(take.slab.rows[1]);
  for (std::size_t j = 0; j < 3; ++j) {
    points.valid[3 * row + j] = 0;
    points.state[3 * row + j] = Tracking::missing;
    for (std::size_t k = 0; k < 3; ++k) points.positions[3 * (3 * row + j) + k] = 0.0;
  }
}

}  // namespace

TEST_CASE(
    "the picture is of the middle of a take, or of the next row in which more joints are tracked") {
  const FreshFolder folder;
  PosixFiles files;
  const TakeName whole{"01", "A", 1}, hidden{"01", "A", 2}, torn{"01", "A", 3}, gone{"01", "A", 4};
  PageTake take = walking_take(80);
  write(folder, files, whole, take);
  hide(take, 40);
  hide(take, 30);
  write(folder, files, hidden, take);
  folder.write(path_of(torn, TakeFile::take), "no HDF5");
  const auto rows = typical_rows(files, folder.path(), {whole, torn, gone, hidden});
  REQUIRE(rows.size() == 4);
  CHECK(rows[1].empty());
  CHECK(rows[2].empty());
  REQUIRE(rows[0].size() == 2);
  CHECK(rows[0][0].parents == std::vector<int>{-1, 0, 1, 2});  // with the end site
  CHECK(rows[0][1].colour == PageColour::kinect);
  CHECK(rows[0][0].positions[0] == doctest::Approx(0.4));  // row 40: the root walks 1 cm a row
  REQUIRE(rows[3].size() == 2);
  CHECK(rows[3][0].positions[0] == doctest::Approx(0.5));
}

TEST_CASE("bodies from a child process are what was sent, or nothing") {
  PageBody body;
  body.colour = PageColour::kinect;
  body.parents = {-1, 0};
  body.positions = {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f};
  body.state = {2, 1};
  const auto read = parse_bodies_json(bodies_json({body}));
  REQUIRE(read.size() == 1);
  CHECK(read[0].parents == body.parents);
  CHECK(read[0].positions == body.positions);
  CHECK(read[0].state == body.state);
  PageBody far = body, short_one = body, odd = body, below = body;
  far.parents[1] = 2;
  below.parents[1] = -2;
  short_one.positions.pop_back();
  odd.state[0] = 3;
  CHECK(parse_bodies_json(bodies_json({far, short_one, odd, below})).empty());
  for (const char* text : {"", "[", "{}", "[1]", "[{}]", "null", "[{\"colour\":1}]"}) {
    CHECK(parse_bodies_json(text).empty());
  }
}
