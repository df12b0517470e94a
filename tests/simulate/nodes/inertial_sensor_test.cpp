// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/inertial_sensor.h"

#include "firmware/imu_node/mpu6886.h"
#include "tests/about.h"

#include <doctest/doctest.h>

#include <numbers>
#include <vector>

using namespace kinalign;

namespace {

/// A chip without faults: all settings that are not named are zero.
InertialSensorModel perfect() {
  InertialSensorModel model;
  model.gyroscope_noise = model.gyroscope_walk = model.gyroscope_zero = model.gyroscope_scale = 0.0;
  model.accelerometer_noise = model.accelerometer_walk = model.accelerometer_zero = 0.0;
  model.accelerometer_scale = model.misalignment = 0.0;
  return model;
}

const InertialReading at_rest{Vec3::Zero(), Vec3(0, 0, standard_gravity)};

struct Spread {
  double mean = 0.0, rms = 0.0;  // rms about the mean
};
Spread spread(const std::vector<double>& values) {
  Spread of;
  for (const double x : values) of.mean += x / static_cast<double>(values.size());
  for (const double x : values) of.rms += (x - of.mean) * (x - of.mean);
  of.rms = std::sqrt(of.rms / static_cast<double>(values.size()));
  return of;
}

}  // namespace

TEST_CASE("registers give the numbers that the firmware computes of them, to the last bit") {
  const SimulatedSensor sensor({}, 1);
  RawReading raw;
  for (int k = 0; k < 2000; ++k) {
    std::array<std::uint8_t, mpu6886::values_size> registers{};
    for (std::size_t i = 0; i < 3; ++i) {
      raw.acceleration[i] = static_cast<std::int16_t>(mix64(6 * k + i));
      raw.angular_velocity[i] = static_cast<std::int16_t>(mix64(6 * k + 3 + i));
      const auto put = [&](std::size_t at, std::int16_t value) {
        registers[at] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(value) >> 8);
        registers[at + 1] = static_cast<std::uint8_t>(value);
      };
      put(2 * i, raw.acceleration[i]);
      put(8 + 2 * i, raw.angular_velocity[i]);
    }
    REQUIRE(sensor.sample_of(raw) == mpu6886::sample_of(registers));
  }
}

TEST_CASE("a chip without faults reads the truth, rounded to its steps") {
  SimulatedSensor sensor(perfect(), 1);
  const InertialReading truth{Vec3(1.0, -2.0, 0.5), Vec3(3.0, -9.0, 0.02)};
  const RawReading raw = sensor.step(truth);
  // 16.384 steps to a degree a second, 2048 to a g: the data sheet's sensitivities.
  CHECK(raw.angular_velocity[0] == std::lround(1.0 * 180.0 / std::numbers::pi * 16.384));
  CHECK(raw.acceleration[1] == std::lround(-9.0 / 9.80665 * 2048.0));
  CHECK((sensor.reading_of(raw).angular_velocity - truth.angular_velocity).norm() < 1e-3);
  CHECK((sensor.reading_of(raw).acceleration - truth.acceleration).norm() < 5e-3);
}

TEST_CASE("what is beyond the range stays at its end") {
  SimulatedSensor sensor(perfect(), 1);
  const RawReading raw = sensor.step({Vec3(40.0, -40.0, 0.0), Vec3(200.0, -200.0, 0.0)});
  CHECK(raw.angular_velocity == std::array<std::int16_t, 3>{32767, -32768, 0});
  CHECK(raw.acceleration == std::array<std::int16_t, 3>{32767, -32768, 0});
}

TEST_CASE("the low-pass lets steady values through, halves power at its bandwidth, and is late") {
  for (const double bandwidth : {41.0, 44.8}) {
    ChipLowPass steady(bandwidth);
    CHECK(steady.push(Vec3(1, 2, 3)) == Vec3(1, 2, 3));
    const auto gain = [&](double hz) {  // also the delay, s, of a sine
      ChipLowPass filter(bandwidth);
      double in_phase = 0.0, quadrature = 0.0;
      constexpr int n = 20000;
      for (int i = 0; i < 2 * n; ++i) {
        const double phase = 2.0 * std::numbers::pi * hz * i * chip_step_s;
        const double out = filter.push(Vec3(std::sin(phase), 0, 0)).x();
        if (i < n) continue;
        in_phase += 2.0 / n * out * std::sin(phase);
        quadrature -= 2.0 / n * out * std::cos(phase);
      }
      return std::pair(std::hypot(in_phase, quadrature),
                       std::atan2(quadrature, in_phase) / (2.0 * std::numbers::pi * hz));
    };
    CHECK(gain(bandwidth).first == about(std::sqrt(0.5), 0.015));
    CHECK(gain(1.0).first == about(1.0, 0.001));
    CHECK(gain(1.0).second == about(0.2049 / bandwidth, 0.01));
  }
}

TEST_CASE("noise at rest is the data sheet's density over the band of the filter") {
  InertialSensorModel model = perfect();
  model.gyroscope_noise = InertialSensorModel{}.gyroscope_noise;
  model.accelerometer_noise = InertialSensorModel{}.accelerometer_noise;
  SimulatedSensor sensor(model, 5);
  std::vector<double> rates, forces;
  for (int i = 0; i < 400'000; ++i) {
    const InertialReading read = sensor.reading_of(sensor.step(at_rest));
    if (i < 100) continue;
    rates.push_back(read.angular_velocity.x());
    forces.push_back(read.acceleration.y());
  }
  // Two equal poles let through pi / 4 of the pole's frequency, which is bandwidth / sqrt(sqrt(2) -
  // 1). Rounding adds a twelfth of a squared step. At a thousand steps a second the poles are a
  // little lower: 5 %.
  const auto predicted = [](double density, double bandwidth, double step) {
    const double band = std::numbers::pi / 4.0 * bandwidth / std::sqrt(std::numbers::sqrt2 - 1.0);
    return std::sqrt(density * density * band + step * step / 12.0);
  };
  const double rate =
      predicted(4e-3 * std::numbers::pi / 180.0, 41.0, model.gyroscope_range / 32768.0);
  const double force = predicted(100e-6 * 9.80665, 44.8, model.accelerometer_range / 32768.0);
  CHECK(spread(rates).rms == about(rate, 0.05));
  CHECK(spread(forces).rms == about(force, 0.05));
  CHECK(std::abs(spread(rates).mean) < 2e-5);
  MESSAGE("rest, rms: " << spread(rates).rms << " rad/s of " << rate << " predicted, "
                        << spread(forces).rms << " m/s2 of " << force);
}

TEST_CASE("zeros, scale and misalignment are drawn within their bounds and act on the truth") {
  double widest_zero = 0.0, widest_scale = 0.0, widest_turn = 0.0;
  const InertialSensorModel model;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const SensorErrors errors = SimulatedSensor(model, seed).errors();
    for (const auto* matrix : {&errors.gyroscope_scale, &errors.accelerometer_scale}) {
      const Eigen::Matrix3d off = *matrix - Eigen::Matrix3d::Identity();
      widest_scale = std::max(widest_scale, off.diagonal().cwiseAbs().maxCoeff());
      Eigen::Matrix3d beside = off;
      beside.diagonal().setZero();
      widest_turn = std::max(widest_turn, beside.cwiseAbs().maxCoeff());
    }
    widest_zero = std::max(widest_zero, errors.gyroscope_zero.cwiseAbs().maxCoeff());
    CHECK(errors.accelerometer_zero.cwiseAbs().maxCoeff() <= model.accelerometer_zero);
  }
  CHECK(widest_zero <= model.gyroscope_zero);
  CHECK(widest_zero > 0.95 * model.gyroscope_zero);
  CHECK(widest_scale <= 0.01);
  CHECK(widest_scale > 0.0095);
  CHECK(widest_turn <= model.misalignment);
  CHECK(widest_turn > 0.95 * model.misalignment);

  InertialSensorModel quiet = model;
  quiet.gyroscope_noise = quiet.gyroscope_walk = 0.0;
  SimulatedSensor sensor(quiet, 9);
  const Vec3 rate(3.0, -1.0, 2.0);
  const Vec3 expected = sensor.errors().gyroscope_scale * rate + sensor.errors().gyroscope_zero;
  const RawReading raw = sensor.step({rate, at_rest.acceleration});
  CHECK((sensor.reading_of(raw).angular_velocity - expected).norm() < 1e-3);
  CHECK((expected - rate).norm() > 0.005);
}

TEST_CASE("zeros walk with the root of time") {
  InertialSensorModel model = perfect();
  model.gyroscope_walk = 2e-5;
  model.accelerometer_walk = 3e-4;
  std::vector<double> rates, forces;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SimulatedSensor sensor(model, seed);
    sensor.wait(200.0);
    for (int i = 0; i < 100; ++i) sensor.wait(2.0);
    rates.push_back(sensor.errors().gyroscope_zero.x());
    forces.push_back(sensor.errors().accelerometer_zero.z());
  }
  CHECK(spread(rates).rms == about(2e-5 * 20.0, 0.15));
  CHECK(spread(forces).rms == about(3e-4 * 20.0, 0.15));
}

TEST_CASE("the same seed is the same chip, another one is another") {
  SimulatedSensor one({}, 3), again({}, 3), other({}, 4);
  for (int i = 0; i < 50; ++i) {
    const RawReading raw = one.step(at_rest);
    CHECK(raw == again.step(at_rest));
    CHECK_FALSE(raw == other.step(at_rest));
  }
}
