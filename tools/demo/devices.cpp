// SPDX-License-Identifier: Apache-2.0
#include "tools/demo/devices.h"

#include "kinalign/core/text_out.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr std::int64_t start_ns = 1'790'000'000'000'000'000;
constexpr double mocap_step = 0.016666667;  // s, the value in the file
constexpr double gravity = 9.80665;

std::int64_t frames_of(const DemoTake& take) {
  return std::max<std::int64_t>(1, std::llround(take.seconds / mocap_step));
}

std::int64_t stamp_at(double t) { return start_ns + std::llround(t * 1e9); }

void write_joint(const DemoBody& body, std::size_t j, int depth, TextOut& out) {
  const DemoJoint& joint = body.joints[j];
  const std::string indent(static_cast<std::size_t>(depth), '\t');
  const auto offset = [&](const Vec3& v, const std::string& before) {
    out.text(before + "OFFSET");
    for (const double x : v) out.number(' ', x, 3);
    out.text("\n");
  };
  out.text(indent + (depth == 0 ? "ROOT " : "JOINT ") + joint.name + "\n" + indent + "{\n");
  offset(joint.offset, indent + "\t");
  out.text(indent + "\tCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n");
  for (std::size_t child = j + 1; child < demo_joints; ++child) {
    if (body.joints[child].parent == static_cast<int>(j)) write_joint(body, child, depth + 1, out);
  }
  if (!joint.end.isZero()) {
    out.text(indent + "\tEnd Site\n" + indent + "\t{\n");
    offset(joint.end, indent + "\t\t");
    out.text(indent + "\t}\n");
  }
  out.text(indent + "}\n");
}

/// A Kinect joint: `part` of the way from one joint to another or to its end site.
struct KinectJoint {
  std::string_view name, from, to;  // `to` empty: the end site
  double part = 0;
};

constexpr std::array<KinectJoint, 25> kinect_joints{{
    {"SpineBase", "Hips", "Spine", 0},
    {"SpineMid", "Spine2", "Spine3", 0},
    {"Neck", "Head", "", 0},
    {"Head", "Head", "", 0.87},
    {"ShoulderLeft", "LeftArm", "LeftForeArm", 0},
    {"ElbowLeft", "LeftForeArm", "LeftHand", 0},
    {"WristLeft", "LeftHand", "LeftInHandMiddle", 0},
    {"HandLeft", "LeftInHandMiddle", "LeftHandMiddle1", 0.5},
    {"ShoulderRight", "RightArm", "RightForeArm", 0},
    {"ElbowRight", "RightForeArm", "RightHand", 0},
    {"WristRight", "RightHand", "RightInHandMiddle", 0},
    {"HandRight", "RightInHandMiddle", "RightHandMiddle1", 0.5},
    {"HipLeft", "LeftUpLeg", "Hips", 0.15},
    {"KneeLeft", "LeftLeg", "LeftFoot", 0},
    {"AnkleLeft", "LeftFoot", "", 0},
    {"FootLeft", "LeftFoot", "", 0.7},
    {"HipRight", "RightUpLeg", "Hips", 0.15},
    {"KneeRight", "RightLeg", "RightFoot", 0},
    {"AnkleRight", "RightFoot", "", 0},
    {"FootRight", "RightFoot", "", 0.7},
    {"SpineShoulder", "Neck", "Head", 0},
    {"HandTipLeft", "LeftHandMiddle3", "", 1},
    {"ThumbLeft", "LeftHandThumb2", "LeftHandThumb3", 0.5},
    {"HandTipRight", "RightHandMiddle3", "", 1},
    {"ThumbRight", "RightHandThumb2", "RightHandThumb3", 0.5},
}};

/// In each half second a joint at the end of a limb is missing in 2 % of the cases, and inferred in
/// 8 %.
int state_of(std::size_t joint, double t, std::uint64_t seed) {
  const bool limb_end = joint == 15 || joint == 19 || joint >= 21;
  if (!limb_end) return 2;
  const auto half_second = static_cast<std::uint64_t>(std::llround(std::floor(2 * t) + 1000));
  DemoRandom random(seed ^ (half_second * 64 + joint));
  random.bits();
  const double draw = random.uniform(0, 1);
  return draw < 0.02 ? 0 : draw < 0.1 ? 1 : 2;
}

class KinectWriter {
 public:
  KinectWriter(const DemoTake& take, const DemoMotion& motion, TextOut& out)
      : take_(take), motion_(motion), out_(out), random_(take.seed * 4 + 1) {
    const DemoBody& body = motion.body();
    for (std::size_t k = 0; k < kinect_joints.size(); ++k) {
      from_[k] = body.find(kinect_joints[k].from);
      to_[k] = kinect_joints[k].to.empty() ? demo_joints : body.find(kinect_joints[k].to);
      for (double& x : beside_[k]) x = random_.uniform(-0.025, 0.025);
    }
  }

  Result<void> write_row(double t) {
    const DemoPlaces places = motion_.places(t);
    out_.integer(stamp_at(t));
    for (std::size_t k = 0; k < kinect_joints.size(); ++k) {
      const int state = state_of(k, t, take_.seed);
      const double noise = state == 2 ? 0.01 : 0.04;  // m
      Vec3 p = camera_from_floor_ * (place(k, places) + beside_[k]) + camera_;
      for (double& x : p) x += noise * random_.normal();
      for (const double x : p) out_.number(',', state == 0 ? 0.0 : x, 4);
      out_.text(state == 0 ? ",0" : state == 1 ? ",1" : ",2");
    }
    return out_.end_line();
  }

 private:
  Vec3 place(std::size_t k, const DemoPlaces& places) const {
    const Vec3& from = places.positions[from_[k]];
    const Vec3 along =
        to_[k] == demo_joints
            ? Vec3(places.rotations[from_[k]] * (0.01 * motion_.body().joints[from_[k]].end))
            : Vec3(places.positions[to_[k]] - from);
    return from + kinect_joints[k].part * along;
  }

  const DemoTake& take_;
  const DemoMotion& motion_;
  TextOut& out_;
  DemoRandom random_;
  std::array<std::size_t, 25> from_{}, to_{};
  // M, offset between each joint and the place at which the camera sees it.
  std::array<Vec3, 25> beside_;
  // The person looks into the camera. The camera's z points at the person, and x to the person's
  // right.
  Quat camera_from_floor_{
      Eigen::AngleAxisd(-(demo_heading_deg + 180) * std::numbers::pi / 180, Vec3::UnitY())};
  Vec3 camera_{0.21, -0.86, 2.64};  // m
};

/// A node on the body: it lies at the joint `at` and turns with the joint `with`.
struct DemoNode {
  std::string_view name, at, with;
};

constexpr std::array<DemoNode, 5> nodes{{{"waist", "Hips", "Hips"},
                                         {"wrist_left", "LeftHand", "LeftForeArm"},
                                         {"wrist_right", "RightHand", "RightForeArm"},
                                         {"ankle_left", "LeftFoot", "LeftLeg"},
                                         {"ankle_right", "RightFoot", "RightLeg"}}};

struct ImuReading {
  Quat orientation;
  Vec3 acceleration, angular_velocity;  // in the node's axes; the acceleration includes gravity
};

ImuReading reading_at(const DemoMotion& motion, const DemoNode& node, double t) {
  constexpr double h = 1e-3;  // s, step of the central differences
  const std::size_t at = motion.body().find(node.at);
  const std::size_t with = motion.body().find(node.with);
  const DemoPlaces before = motion.places(t - h);
  const DemoPlaces here = motion.places(t);
  const DemoPlaces behind = motion.places(t + h);
  const Vec3 bend =
      (before.positions[at] - 2 * here.positions[at] + behind.positions[at]) / (h * h);
  const Quat to_node = here.rotations[with].conjugate();
  const Eigen::AngleAxisd turned(before.rotations[with].conjugate() * behind.rotations[with]);
  return {here.rotations[with], to_node * Vec3(bend + gravity * Vec3::UnitY()),
          turned.axis() * (turned.angle() / (2 * h))};
}

Result<void> write_imu(const DemoTake& take, const DemoMotion& motion, std::size_t n) {
  TextOut out = KA_TRY(TextOut::create(
      take.files, take.folder + "imu_" + std::string(nodes[n].name) + ".csv", Overwrite::yes));
  DemoRandom random(take.seed * 4 + 2 + 1000 * (n + 1));
  out.text("time_ns,qw,qx,qy,qz,ax,ay,az,gx,gy,gz\n");
  const double phase = random.uniform(-0.3, -0.2);
  for (double due = phase; due < take.seconds + 0.2; due += 1 / 15.0) {
    const double t = due + random.uniform(-0.004, 0.004);
    const double doubt = random.uniform(-0.0035, 0.0035);  // error of the stamp, s
    if (random.uniform(0, 1) < 0.018) continue;            // the sample is lost
    const ImuReading reading = reading_at(motion, nodes[n], t);
    const Quat& q = reading.orientation;
    out.integer(stamp_at(t + doubt));
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) out.number(',', x, 6);
    for (const double x : reading.acceleration) out.number(',', x + 0.05 * random.normal(), 4);
    for (const double x : reading.angular_velocity) out.number(',', x + 0.01 * random.normal(), 4);
    KA_TRY(out.end_line());
  }
  return out.commit();
}

}  // namespace

Result<void> write_demo_mocap(const DemoTake& take, const DemoMotion& motion) {
  TextOut out = KA_TRY(TextOut::create(take.files, take.folder + "mocap.bvh", Overwrite::yes));
  const std::int64_t frames = frames_of(take);
  out.text("HIERARCHY\n");
  write_joint(motion.body(), 0, 0, out);
  out.text("MOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: 0.016666667\n");
  for (std::int64_t i = 0; i < frames; ++i) {
    const DemoPose pose = motion.pose(static_cast<double>(i) * mocap_step);
    char before = '\0';
    for (std::size_t j = 0; j < demo_joints; ++j) {
      for (const Vec3* three : {&pose.positions[j], &pose.angles[j]}) {
        for (const double x : *three) {
          out.number(before, x, 4);
          before = ' ';
        }
      }
    }
    KA_TRY(out.end_line());
  }
  return out.commit();
}

Result<void> write_demo_kinect(const DemoTake& take, const DemoMotion& motion) {
  TextOut out = KA_TRY(TextOut::create(take.files, take.folder + "kinect.csv", Overwrite::yes));
  out.text("time_ns");
  for (const KinectJoint& joint : kinect_joints) {
    for (const char* part : {"_x", "_y", "_z", "_state"}) {
      out.text("," + std::string(joint.name) + part);
    }
  }
  KA_TRY(out.end_line());
  KinectWriter writer(take, motion, out);
  DemoRandom random(take.seed * 4 + 3);
  const double first_gap = 0.4 * take.seconds;
  const double second_gap = 0.7 * take.seconds;
  for (double due = -0.23; due < take.seconds + 0.2; due += 1 / 30.0) {
    const double t = due + random.uniform(-0.002, 0.002);
    const bool lost = random.uniform(0, 1) < 0.005 || (t > first_gap && t < first_gap + 0.3) ||
                      (t > second_gap && t < second_gap + 0.45);
    if (!lost) KA_TRY(writer.write_row(t));
  }
  return out.commit();
}

Result<void> write_demo_imus(const DemoTake& take, const DemoMotion& motion) {
  for (std::size_t n = 0; n < nodes.size(); ++n) KA_TRY(write_imu(take, motion, n));
  return {};
}

Result<void> write_demo_manifest(const DemoTake& take) {
  TextOut out = KA_TRY(TextOut::create(take.files, take.folder + "recording.toml", Overwrite::yes));
  const auto span = std::llround(static_cast<double>(frames_of(take)) * mocap_step * 1e9);
  out.text("# Made by kinalign_demo_recording --seed " + std::to_string(take.seed) + "\n");
  out.text("subject = \"" + take.subject + "\"\naction = \"" + take.action + "\"\n");
  out.text("\n[align]\nreference = \"mocap\"\n\n[stream.mocap]\nfile = \"mocap.bvh\"\n");
  out.text("start_ns = " + std::to_string(start_ns) + "\n");
  out.text("end_ns = " + std::to_string(start_ns + span) + "\n");
  out.text("\n[stream.kinect]\nfile = \"kinect.csv\"\nclock = \"shared\"\n");
  out.text("\n[stream.imu]\nroot_node = \"waist\"\ninterval_ms = 3.6\nfiles = { ");
  for (const DemoNode& node : nodes) {
    out.text(std::string(&node == &nodes[0] ? "" : ", ") + std::string(node.name) + " = \"imu_" +
             std::string(node.name) + ".csv\"");
  }
  out.text(" }\n\n[space.kinect]\nmethod = \"fit\"\njoints = { ");
  bool first = true;
  for (const KinectJoint& joint : kinect_joints) {
    if (joint.part >= 0.5) continue;  // the joint lies between two joints of the skeleton
    out.text(std::string(first ? "" : ", ") + std::string(joint.name) + " = \"" +
             std::string(joint.from) + "\"");
    first = false;
  }
  out.text(" }\n");
  return out.commit();
}

}  // namespace kinalign
