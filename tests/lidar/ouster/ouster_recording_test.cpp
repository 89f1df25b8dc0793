#include "canyon/lidar/ouster/recording.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/tests/lidar/ouster/made_recording.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar::ouster {
namespace {

using testing::capture;
using testing::kMetadata;
using testing::packet;

class OusterRecording : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) const {
    EXPECT_TRUE(write_text_file(folder_.file(name), bytes).ok());
    return folder_.file(name);
  }
  std::string refusal(const std::string& text) const {
    const auto metadata = read_metadata(file("bad.json", text));
    return metadata.ok() ? "" : metadata.error().str().substr(folder_.path().string().size() + 1);
  }
  canyon::testing::TemporaryFolder folder_;
};

TEST_F(OusterRecording, PlacesOfReturnsByHand) {
  const auto metadata = read_metadata(file("a.json", kMetadata));
  ASSERT_TRUE(metadata.ok()) << metadata.error().str();
  const auto frames = read_frames(
      file("a_b.pcap", capture({packet(7, 0), "an inertial packet", packet(7, 2), packet(8, 0, false)})), *metadata);
  ASSERT_TRUE(frames.ok()) << frames.error().str();
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_EQ((*frames)[0].id, 7);
  EXPECT_EQ((*frames)[0].columns, 4);
  EXPECT_EQ((*frames)[1].columns, 0) << "columns that are said to be bad";
  ASSERT_EQ((*frames)[0].returns.size(), 12U) << "a range of 0 is none";
  const auto at = [&](int column, int pixel) {
    for (const Return& r : (*frames)[0].returns)
      if (r.column == column && r.pixel == pixel) return r;
    ADD_FAILURE();
    return Return{};
  };
  // Column 0 looks along the head's x, which is the sensor's -x; 8 m from the axis, 20 mm of which are not along the
  // beam.
  const double along = 7.98;
  const auto expect = [&](int column, int pixel, const Eigen::Vector3d& p) {
    EXPECT_LT((at(column, pixel).p_m - p).norm(), 1e-12)
        << column << ' ' << pixel << ": " << at(column, pixel).p_m.transpose();
  };
  expect(0, 1, {-8.0, 0.0, 0.036});
  expect(0, 0, {-(along * std::sqrt(0.75) + 0.02), 0.0, 0.5 * along + 0.036});
  // A quarter of the turn on, clockwise: the head's -y, the sensor's y.
  expect(1, 1, {0.0, 8.0, 0.036});
  // 90 degrees clockwise of the head: at column 0 that is the head's -y.
  expect(0, 2, {-0.02, along, 0.036});
  EXPECT_EQ(at(2, 2).reflectivity, 42);
  EXPECT_EQ(at(3, 0).t_ns, 1000000010);
  EXPECT_EQ(at(3, 0).range_m, 8.0);

  // As a cloud, with the JSON of a shorter name.
  const auto cloud = read_cloud(folder_.file("a_b.pcap"));
  ASSERT_TRUE(cloud.ok()) << cloud.error().str();
  EXPECT_EQ(cloud->points.size(), 12U);
}

TEST_F(OusterRecording, WhatIsWrongIsSaid) {
  EXPECT_EQ(refusal("{"), "bad.json:1: the JSON text ends too early, expected a complete JSON value");
  EXPECT_EQ(
      refusal("{}"),
      "bad.json: udp_profile_lidar: is missing or wrong, expected \"RNG15_RFL8_NIR8\", the low-bandwidth profile");
  std::string text = kMetadata;
  text.replace(text.find("[30, 0, 0, -30]"), 15, "[30, 0, 0]");
  EXPECT_EQ(refusal(text),
            "bad.json: beam_altitude_angles: is missing or wrong, expected degrees, one for each pixel of a column");
  text = kMetadata;
  text.replace(text.find("\"columns_per_frame\": 4"), 22, "\"columns_per_frame\": 0");
  EXPECT_EQ(refusal(text), "bad.json: columns_per_frame: is missing or wrong, expected a number of columns");
  const auto metadata = read_metadata(file("a.json", kMetadata));
  const auto none = read_frames(file("a.pcap", capture({"12345"})), *metadata);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().str().substr(folder_.path().string().size() + 1),
            "a.pcap: holds no packet of 120 bytes, expected packets as its metadata describes them");
  const std::string whole = capture({packet(7, 0), packet(7, 2)});
  const auto cut = read_frames(file("a.pcap", whole.substr(0, whole.size() - 1)), *metadata);
  ASSERT_FALSE(cut.ok());
  EXPECT_EQ(cut.error().str().substr(folder_.path().string().size() + 1),
            "a.pcap: ends inside packet 2, expected a whole capture");
}

struct RealScans {
  std::vector<Frame> frames;
  std::vector<Pose> X_WS;  ///< as published with the recording
};
RealScans real_scans(const std::string& capture_path, const std::string& metadata_path, const std::string& poses_path) {
  RealScans out{*read_frames(capture_path, *read_metadata(metadata_path)), {}};
  std::ifstream file(poses_path);
  for (Eigen::Matrix4d T = Eigen::Matrix4d::Identity(); file >> T(0, 0);) {
    for (int i = 1; i < 12; ++i) file >> T(i / 4, i % 4);
    out.X_WS.push_back(Pose::from_matrix(T));
  }
  return out;
}
#define CANYON_REAL_SCANS(scans)                                                              \
  CANYON_REAL_DATA(capture_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap");          \
  CANYON_REAL_DATA(metadata_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10.json");               \
  CANYON_REAL_DATA(poses_path, "lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3_poses_kitti.txt"); \
  const RealScans scans = real_scans(capture_path, metadata_path, poses_path)

std::vector<Eigen::Vector3f> floats(const Frame& frame) {
  std::vector<Eigen::Vector3f> out;
  for (const Return& r : frame.returns) out.push_back(r.p_m.cast<float>());
  return out;
}

TEST(OusterScans, ThreeWholeTurns) {
  CANYON_REAL_SCANS(scans);
  ASSERT_EQ(scans.frames.size(), 3U);
  ASSERT_EQ(scans.X_WS.size(), 3U);
  for (const Frame& frame : scans.frames) {
    EXPECT_EQ(frame.columns, 1024);
    std::printf("%zu returns\n", frame.returns.size());
    EXPECT_GT(frame.returns.size(), 40000U);
    // A tenth of a second for a turn.
    EXPECT_NEAR(1e-9 * static_cast<double>(frame.returns.back().t_ns - frame.returns.front().t_ns), 0.1, 0.003);
  }
  // Found without naming the JSON, which has no "_lb_n3".
  EXPECT_EQ(ouster::metadata_path(capture_path), metadata_path);
}

std::unique_ptr<Registration> fine_gicp() {
  auto tree = ConfigNode::parse("method = \"gicp\"\nleaf_m = 0.25\n", "test.toml");
  RegistrationConfig config;
  EXPECT_TRUE(read_config(&*tree, "registration", config).ok());
  return *make_registration(config);
}

Vector6d error_of(const RealScans& scans, std::size_t from, std::size_t onto, const Pose& X_TS) {
  return ((scans.X_WS[onto].inverse() * scans.X_WS[from]).inverse() * X_TS).log();
}

// The published poses are those of a map that was made of many scans; how good they are is not said.
TEST(OusterScans, RegisteredScansAgreeWithTheirPoses) {
  CANYON_REAL_SCANS(scans);
  const auto gicp = fine_gicp();
  for (const auto& [from, onto] : {std::pair<std::size_t, std::size_t>{1, 0}, {2, 1}, {2, 0}}) {
    const Registration::Placed placed{gicp->prepare(floats(scans.frames[onto])), Pose{}};
    const auto result = gicp->align(*gicp->prepare(floats(scans.frames[from])), {&placed, 1}, Pose{});
    EXPECT_EQ(result.status, RegistrationStatus::kConverged);
    const Vector6d error = error_of(scans, from, onto, result.X_TS);
    std::printf("scan %zu onto %zu: %.1f mm, %.3f deg off its pose, of %.0f mm\n", from, onto,
                1e3 * error.tail<3>().norm(), error.head<3>().norm() / kDegree,
                1e3 * (scans.X_WS[onto].inverse() * scans.X_WS[from]).p.norm());
    EXPECT_LT(error.tail<3>().norm(), 0.03);
    EXPECT_LT(error.head<3>().norm(), 0.15 * kDegree);
  }
}

/// Each ring of guesses wants as many right of a hundred as is asked for: within 0.1 m and 1 degree of the poses.
void expect_right_from_rings(const RealScans& scans, std::uint64_t starts) {
  const auto gicp = fine_gicp();
  const auto source = gicp->prepare(floats(scans.frames[2]));
  const Registration::Placed placed{gicp->prepare(floats(scans.frames[0])), Pose{}};
  const Pose truth = scans.X_WS[0].inverse() * scans.X_WS[2];
  struct Ring {
    double m, deg, wanted;
  };
  const RandomStream random(3, "test.rings");
  for (const Ring& ring : {Ring{0.5, 2, 0.99}, Ring{1, 5, 0.99}, Ring{2, 10, 0.8}}) {
    double right = 0.0;
    for (std::uint64_t k = 0; k < starts; ++k) {
      Vector6d off;
      off << ring.deg * kDegree * random.direction(0, k), ring.m * random.direction(1, k);
      const Vector6d error = error_of(scans, 2, 0, gicp->align(*source, {&placed, 1}, truth * Pose::exp(off)).X_TS);
      right += error.tail<3>().norm() < 0.1 && error.head<3>().norm() < kDegree ? 1.0 : 0.0;
    }
    std::printf("from %.1f m, %.0f deg: %.0f of %d right\n", ring.m, ring.deg, right, static_cast<int>(starts));
    EXPECT_GE(right, ring.wanted * static_cast<double>(starts)) << ring.m;
  }
}

TEST(OusterScans, FromRingsOfGuesses) {
  CANYON_REAL_SCANS(scans);
  expect_right_from_rings(scans, 10);
}

TEST(OusterScans, FromRingsOf200GuessesNightly) {
  CANYON_REAL_SCANS(scans);
  expect_right_from_rings(scans, 200);
}

}  // namespace
}  // namespace canyon::lidar::ouster
