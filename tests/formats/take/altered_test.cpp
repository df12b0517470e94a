// SPDX-License-Identifier: Apache-2.0
// A take that another program has changed: the reader names the change in one line before it uses
// any of the data.
#include "tests/folder.h"
#include "tests/formats/take/take_samples.h"
#include "tests/witness.h"

#include "kinalign/formats/take/take_hdf5.h"

#include <doctest/doctest.h>

#include <set>

using namespace kinalign;

namespace {

struct Altered {
  std::string name;     // name of a change in tests/witness/take_altered.py
  std::string message;  // the message after the file's name
};

const std::string one_piece =
    "expected positions as an array in one piece, uncompressed (h5repack -l CONTI -f NONE makes "
    "it), found another layout";

const std::vector<Altered> alterations{
    {"no stamps", "expected time_ns as a data set, found none"},
    {"stamps of seconds", "expected time_ns as numbers of 8 bytes, found another type"},
    {"one stamp", "expected time_ns as an array, found one value"},
    {"stamps that stand", "expected rising stamps, found other content in time_ns"},
    {"chunks", one_piece},
    {"compression", one_piece},
    {"a soft link", "expected positions as a data set, found none"},
    {"another file's array", "expected positions as a data set, found none"},
    {"five dimensions",
     "expected positions as an array of at most four dimensions, found another rank or no array"},
    {"four joints", "expected positions as [20,3,3], found [20,4,3]"},
    {"a row less", "expected valid as [20,2], found [19,2]"},
    {"a great array without bytes",
     "expected positions as an array inside the file, found a position beyond its end"},
    {"double where float is stored",
     "expected positions as numbers of 4 bytes, found another type"},
    {"numbers the other way round", "expected positions as numbers of 4 bytes, found another type"},
    {"no orientations' validity", "expected valid as a data set, found none"},
    {"texts of any length", "expected joint_names as text of fixed length, found another type"},
    {"one joint name", "expected joint_names as a list of texts, found []"},
    {"joints of one name", "expected a name for each joint, only once, found \"Head\""},
    {"a list of parameters", "expected parameters_json as one text, found [1]"},
    {"parameters of another key",
     "expected a known key (known: align, schema, spaces, streams, subject, action), found "
     "\"colour\""},
    {"no kind", "expected kind as an attribute of one text, found none"},
    {"another kind", "expected a kind of stream: clip, points or imu, found \"ghost\""},
    {"another format", "expected format kinalign.take/1, found \"kinalign.take/2\""},
    {"no format", "expected a take that kinalign wrote, found HDF5 of another kind"},
    {"a number for software",
     "expected software as an attribute of text, found something of another kind"},
    {"a subject of any length",
     "expected subject as an attribute of text, found something of another kind"},
    {"a stream twice", "expected a name for each stream, only once, found \"mocap\""},
    {"a hash less", "expected input_sha256 as one entry for each name, found others"},
    {"no sizes of inputs",
     "expected input_bytes as one number for each name, found something of another kind"},
    {"a child before its parent", "expected each parent before its children, found joint 'Spine'"},
    {"an end site of no joint", "expected an end site's joint, found other content in end_sites"},
    {"a place that is no number", "expected finite numbers, found other content in positions"},
    {"an endless turn", "expected finite numbers, found other content in local_rotations"},
    {"a distance below zero", "expected times of 0 or more, found other content in nearest_raw_ns"},
    {"a fourth state", "expected values up to 2, found other content in state"},
    {"more than valid", "expected values up to 1, found other content in valid"},
    {"more than we know", ""},
};

}  // namespace

TEST_CASE("a take that was altered in one place is refused with the place, or reads as it was") {
  const FreshFolder folder;
  PosixFiles files;
  const Take take = sample_take(20);
  auto writer = TakeWriter::create(files, folder / "take.h5", Overwrite::no, take.header);
  REQUIRE(writer);
  REQUIRE(writer->append(take.all));
  REQUIRE(writer->finish(take.report));
  REQUIRE(run_witness("take_altered.py", folder.path()) == 0);
  std::set<std::string> made{"take.h5"};
  for (const auto& [name, message] : alterations) {
    CAPTURE(name);
    const std::string path = folder / (name + ".h5");
    const auto read = read_take(files, path);
    CHECK((read ? "" : to_string(read.error())) == (message.empty() ? "" : path + ": " + message));
    made.insert(name + ".h5");
  }
  const auto all = folder.names();
  CHECK(std::set<std::string>(all.begin(), all.end()) == made);
}
