// SPDX-License-Identifier: Apache-2.0
// Reads the sensors of an MVNX file as inertial nodes.
#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/mvnx/document.h"
#include "kinalign/formats/mvnx/frame_stamps.h"
#include "kinalign/formats/mvnx/mvnx.h"

#include <fmt/format.h>

#include <optional>

namespace kinalign {

namespace {

/// Reads sensors. The first normal frame determines the quantities, and later frames must have the
/// same arrays.
class MvnxSensorReader final : public ImuReader {
 public:
  MvnxSensorReader(const StreamOptions& options, std::string_view file)
      : stamps_(options),
        samples_(ImuUnits{axes_of(z_up, options), 1.0, 1.0}),
        document_(file, [this](const MvnxHead& head, const MvnxFrame& frame) {
          return use(head, frame);
        }) {}
  // A callback in document_ contains the address of this object.
  MvnxSensorReader(const MvnxSensorReader&) = delete;
  MvnxSensorReader& operator=(const MvnxSensorReader&) = delete;
  ~MvnxSensorReader() override = default;

  Result<void> feed(std::string_view piece, ImuSamples& out) override {
    out_ = &out;
    return document_.feed(piece);
  }

  Result<void> finish(ImuSamples& out) override {
    out_ = &out;
    KA_TRY(document_.finish(findings));
    const std::string& file = document_.file();
    if (!header_) {
      return refuse(file, "a frame of type normal with sensors", "the end of the file");
    }
    if (incomplete_ > 0) {
      add_warning(findings,
                  {file, 0, "the same sensor values in each frame as in the first frame",
                   fmt::format("{} frames without them", incomplete_)},
                  "their samples are invalid");
    }
    samples_.report(file, findings);
    stamps_.report(file, findings);
    return {};
  }

  const ImuHeader* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  Result<void> use(const MvnxHead& head, const MvnxFrame& frame) {
    if (frame.type != "normal") return {};
    // The header comes before the stamp: a file without sensors must fail even if its first index
    // is wrong.
    if (!header_) KA_TRY(begin(head, frame));
    const auto stamp = KA_TRY(stamps_.next(head, frame));
    if (!stamp) return {};
    out_->stamps.push_back(*stamp);
    append(frame);
    return {};
  }

  /// Decides at the first normal frame which quantities are read.
  Result<void> begin(const MvnxHead& head, const MvnxFrame& frame) {
    const std::size_t sensors = head.sensors.size();
    // An array of another size can't be divided among the sensors.
    const bool turn = sensors > 0 && frame.sensor_orientation.size() == 4 * sensors;
    const bool force = frame.sensor_acceleration.size() == 3 * sensors;
    // The orientation is needed to rotate a free acceleration into sensor space.
    free_ = !force && turn && frame.sensor_free_acceleration.size() == 3 * sensors;
    const bool rate = frame.sensor_angular_velocity.size() == 3 * sensors;
    if (sensors == 0 || !(turn || force || rate)) {
      return refuse("sensors with orientation, acceleration or angular velocity",
                    "no such sensors in the first frame");
    }
    // The last value says whether the acceleration contains gravity.
    header_ = ImuHeader{head.sensors, {turn, force || free_, rate, !free_}};
    return {};
  }

  /// Appends one sample of each sensor. If an array is incomplete, all samples of the frame are
  /// invalid.
  void append(const MvnxFrame& frame) {
    const std::size_t sensors = header_->node_names.size();
    const ImuContent& content = header_->content;
    const std::vector<double>& acceleration =
        free_ ? frame.sensor_free_acceleration : frame.sensor_acceleration;
    // If one array is incomplete, all samples of the frame are invalid.
    const bool whole =
        (!content.orientation || frame.sensor_orientation.size() == 4 * sensors) &&
        (!content.acceleration || acceleration.size() == 3 * sensors) &&
        (!content.angular_velocity || frame.sensor_angular_velocity.size() == 3 * sensors);
    incomplete_ += whole ? 0 : 1;
    // An invalid sample needs valid pointers, too.
    constexpr double zeros[4] = {};
    for (std::size_t s = 0; s < sensors; ++s) {
      const auto of = [&](const std::vector<double>& array, std::size_t parts) {
        return whole ? &array[parts * s] : zeros;
      };
      RawImuSample raw{nullptr, nullptr, nullptr, whole};
      Vec3 local = Vec3::Zero();
      if (content.orientation) raw.orientation = of(frame.sensor_orientation, 4);
      if (content.angular_velocity) raw.angular_velocity = of(frame.sensor_angular_velocity, 3);
      if (content.acceleration) raw.acceleration = of(acceleration, 3);
      // Rotates the vector from the world to sensor space.
      if (free_ && whole) {
        local = quat(frame.sensor_orientation, s).normalized().conjugate() *
                Vec3(vec3(acceleration, s));
        raw.acceleration = local.data();
      }
      samples_.append(raw, *out_);
    }
  }

  MvnxStamps stamps_;
  ImuConverter samples_;
  MvnxDocument document_;
  ImuSamples* out_ = nullptr;  // the output during a call
  bool free_ = false;          // the file's accelerations are global and exclude gravity
  std::uint64_t incomplete_ = 0;
  std::optional<ImuHeader> header_;
};

}  // namespace

std::unique_ptr<ImuReader> make_mvnx_sensor_reader(const StreamOptions& options,
                                                   std::string_view file) {
  return std::make_unique<MvnxSensorReader>(options, file);
}

}  // namespace kinalign
