// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/channels.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

/// The direction in our axes of the axis that points up in the file, and the handedness of the
/// file's axes: 1 right-handed, -1 left-handed.
struct Turned {
  Vec3 up;
  int hand = 0;
};

std::optional<Turned> turned_by(const std::string& letters) {
  const auto axes = axes_of_letters(letters);
  if (!axes) return std::nullopt;
  std::array<double, 3> up{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (letters[k] == 'S') up[k] = 1.0;
    if (letters[k] == 'I') up[k] = -1.0;
  }
  return Turned{turned(*axes, up.data()), determinant(*axes)};
}

}  // namespace

TEST_CASE("what SpatialAxes say is up becomes y, and a left-handed space is mirrored") {
  for (const std::string right_handed :
       {"LSA", "RSP", "ASR", "RAS", "ALS", "SRA", "SPR", "RIA", "ARI", "ILA", "_S_", "__S"}) {
    CAPTURE(right_handed);
    const auto found = turned_by(right_handed);
    REQUIRE(found);
    CHECK(found->up == Vec3(0, 1, 0));
    CHECK(found->hand == 1);
  }
  for (const std::string left_handed : {"ARS", "LAS", "RSA", "ALI", "SAR"}) {
    CAPTURE(left_handed);
    const auto found = turned_by(left_handed);
    REQUIRE(found);
    CHECK(found->up == Vec3(0, 1, 0));
    CHECK(found->hand == -1);
  }
  CHECK(axes_of_letters("LSA") == y_up);
  CHECK(axes_of_letters("ALS") == z_up);
}

TEST_CASE("letters that are no axes are none") {
  for (const char* none : {"", "ALR", "AL", "AAS", "XYZ", "n/a", "LSAS"}) {
    CAPTURE(none);
    CHECK(!axes_of_letters(none));
  }
}

TEST_CASE("channels of a stream have BIDS' names, types, units and frames") {
  const ImuHeader nodes{{"waist"},
                        {.orientation = true, .acceleration = true, .angular_velocity = true}};
  CHECK(write_tsv(channels_table(bids_channels(nodes))) ==
        "name\tcomponent\ttype\ttracked_point\tunits\tplacement\treference_frame\n"
        "latency\tn/a\tLATENCY\tn/a\ts\tn/a\tn/a\n"
        "waist_ORNT_quat_w\tquat_w\tORNT\twaist\tn/a\twaist\tglobal\n"
        "waist_ORNT_quat_x\tquat_x\tORNT\twaist\tn/a\twaist\tglobal\n"
        "waist_ORNT_quat_y\tquat_y\tORNT\twaist\tn/a\twaist\tglobal\n"
        "waist_ORNT_quat_z\tquat_z\tORNT\twaist\tn/a\twaist\tglobal\n"
        "waist_ACCEL_x\tx\tACCEL\twaist\tm/s^2\twaist\tsensor\n"
        "waist_ACCEL_y\ty\tACCEL\twaist\tm/s^2\twaist\tsensor\n"
        "waist_ACCEL_z\tz\tACCEL\twaist\tm/s^2\twaist\tsensor\n"
        "waist_GYRO_x\tx\tGYRO\twaist\trad/s\twaist\tsensor\n"
        "waist_GYRO_y\ty\tGYRO\twaist\trad/s\twaist\tsensor\n"
        "waist_GYRO_z\tz\tGYRO\twaist\trad/s\twaist\tsensor\n");
  CHECK(bids_channels(PointHeader{{"A", "B"}}).size() == 7);
  CHECK(bids_channels(Skeleton{{"Hips"}, {-1}, {Vec3::Zero()}, {}}).size() == 8);
  CHECK(unit_scale("POS", "mm") == 0.001);
  CHECK(unit_scale("GYRO", "deg/s") == doctest::Approx(0.0174532925));
  CHECK(unit_scale("POS", "rad") == 0.0);
}

TEST_CASE("a table of channels is read back, also with its columns elsewhere; five are needed") {
  const auto channels = bids_channels(PointHeader{{"A\tB"}});
  const auto read = channels_of(read_tsv(write_tsv(channels_table(channels))), "c.tsv");
  REQUIRE(read);
  CHECK((*read)[1].name == "A B_POS_x");
  const auto other = channels_of(
      read_tsv("units\tname\ttype\tcomponent\ttracked_point\nmm\tn\tPOS\tx\tp\r\n"), "c.tsv");
  REQUIRE(other);
  CHECK((*other)[0].units == "mm");
  CHECK((*other)[0].reference_frame == "n/a");
  CHECK(to_string(channels_of(read_tsv("name\ttype\n"), "c.tsv").error()) ==
        "c.tsv:1: expected a column component, found none");
}
