#include "canyon/tests/mutation/format.h"

namespace canyon::testing {
namespace {

/// A figure of eight, two seconds of it, by a sensor with errors: the log in both formats, and the truth.
const std::vector<Seed>& simulated_imu() {
  static const std::vector<Seed> files =
      written_by_canyon({"imu", "simulate", "--path", "figure_eight", "--at", "45,7,200", "--rate", "50", "--duration",
                         "2", "--start", "1612:520200", "--out", "log"},
                        {"log/imu.csv", "log/imu_kf_gins.txt", "log/truth.nav"});
  return files;
}

/// At rest, long enough for an Allan deviation.
const std::vector<Seed>& resting() {
  static const std::vector<Seed> files =
      written_by_canyon({"imu", "simulate", "--path", "stationary", "--at", "45,7,200", "--rate", "20", "--duration",
                         "15", "--start", "1612:520200", "--out", "log"},
                        {"log/imu.csv"});
  return files;
}

constexpr const char* kTruthCsv =
    "gps_week,sow,lat_deg,lon_deg,h_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,heading_deg\n"
    "1612,520200,45,7,200,1,0,0,0.5,0.2,10\n1612,520201,45.000009,7,200,1,0,0,0.5,0.2,11\n"
    "1612,520202,45.000018,7,200,1,0,0,0.4,0.2,12\n1612,520203,45.000027,7,200,1,0,0,0.4,0.1,13\n";

constexpr const char* kTum =
    "# a comment\n520200.0 0 0 1 0 0 0 1\n520200.5 1 0 1 0 0 0.05 0.99875\n520201.0 2 0.1 1 0 0 0.1 0.995\n"
    "520201.5 3 0.3 1 0 0 0.15 0.98869\n520202.0 4 0.6 1 0 0 0.2 0.97980\n";

constexpr const char* kKitti =
    "1.00000000 -0.00000000 0 0 0.00000000 1.00000000 0 0 0 0 1 1\n"
    "0.99980001 -0.01999867 0 0.2 0.01999867 0.99980001 0 0.002 0 0 1 1\n"
    "0.99920011 -0.03998933 0 0.4 0.03998933 0.99920011 0 0.008 0 0 1 1\n"
    "0.99820054 -0.05996401 0 0.6 0.05996401 0.99820054 0 0.018 0 0 1 1\n"
    "0.99680171 -0.07991469 0 0.8 0.07991469 0.99680171 0 0.032 0 0 1 1\n"
    "0.99500417 -0.09983342 0 1 0.09983342 0.99500417 0 0.05 0 0 1 1\n"
    "0.99280864 -0.11971221 0 1.2 0.11971221 0.99280864 0 0.072 0 0 1 1\n"
    "0.99021600 -0.13954311 0 1.4 0.13954311 0.99021600 0 0.098 0 0 1 1\n"
    "0.98722728 -0.15931821 0 1.6 0.15931821 0.98722728 0 0.128 0 0 1 1\n"
    "0.98384369 -0.17902957 0 1.8 0.17902957 0.98384369 0 0.162 0 0 1 1\n"
    "0.98006658 -0.19866933 0 2 0.19866933 0.98006658 0 0.2 0 0 1 1\n"
    "0.97589745 -0.21822962 0 2.2 0.21822962 0.97589745 0 0.242 0 0 1 1\n"
    "0.97133797 -0.23770263 0 2.4 0.23770263 0.97133797 0 0.288 0 0 1 1\n"
    "0.96638998 -0.25708055 0 2.6 0.25708055 0.96638998 0 0.338 0 0 1 1\n";

constexpr const char* kPoses =
    "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1612,520200,0,0,1,1,0,0,0\n1612,520200.5,1,0,1,0.99875,0,0,0.05\n"
    "1612,520201,2,0.1,1,0.995,0,0,0.1\n1612,520201.5,3,0.3,1,0.98869,0,0,0.15\n1612,520202,4,0.6,1,0.9798,0,0,0.2\n";

constexpr const char* kMissionPoses =
    "t_s,gps_week,sow,true_x_m,true_y_m,true_z_m,true_yaw_deg,true_pitch_deg,true_roll_deg,true_speed_m_s\n"
    "0,1612,520200,0,0,1,0,0,0,2\n0.5,1612,520200.5,1,0,1,5,0,0,2\n1,1612,520201,2,0.1,1,11,0,0,2\n"
    "1.5,1612,520201.5,3,0.3,1,17,1,0,2\n2,1612,520202,4,0.6,1,22,1,2,2\n";

constexpr const char* kPoints = "t_s,x_m,y_m,z_m\n0,0,0,1\n0.5,1,0,1\n1,2,0.1,1\n1.5,3,0.3,1.1\n2,4,0.6,1.2\n";
constexpr const char* kPointsWithAttitude =
    "t_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg\n0,0,0,1,0,0,0\n0.5,1,0,1,5,1,0\n1,2,0.1,1,10,0,1\n1.5,3,0.3,1.1,15,0,"
    "1\n"
    "2,4,0.6,1.2,20,0,0\n";

constexpr const char* kMotion = R"(path = "figure_eight"
lat_deg = 45.0
lon_deg = 7.0
height_m = 200.0
length_m = 120.0
width_m = 100.0
period_s = 75.0
climb_m = 2.0
sway_deg = 4.0
[vibration]
psd_hz = [10.0, 20.0, 80.0, 200.0]
psd_g2_per_hz = [1e-5, 4e-4, 4e-4, 1e-5]
[[vibration.sinusoid]]
frequency_hz = 30.0
acceleration_m_s2 = [0.0, 0.5, 1.5]
angle_deg = [0.02, 0.01, 0.0]
[imu]
sensor = "stim300"
errors = "full"
rate_hz = 50.0
lever_arm_m = [0.3, 0.0, 0.5]
)";
constexpr const char* kCircle = "path = \"circle\"\nradius_m = 20.0\nspeed_m_s = 5.0\n[imu]\nrate_hz = 50.0\n";

/// Every figure that the catalogue knows, without its source where that is optional.
constexpr const char* kSensor = R"(name = "mine"
description = "a made-up sensor"
[gyro]
arw_deg_per_sqrt_hr = 0.15
arw_source = "made up"
turn_on_bias_deg_per_hr = 3.0
turn_on_bias_source = "made up"
in_run_bias_deg_per_hr = 0.5
in_run_bias_source = "made up"
in_run_bias_tau_s = 1000.0
in_run_bias_tau_source = "made up"
scale_ppm = 500.0
scale_source = "made up"
misalignment_mrad = 1.0
misalignment_source = "made up"
bias_instability_deg_per_hr = 0.5
bias_instability_source = "made up"
flicker_low_hz = 1e-05
flicker_low_source = "made up"
flicker_high_hz = 0.1
flicker_high_source = "made up"
range_deg_per_s = 400.0
range_source = "made up"
bandwidth_hz = 262.0
bandwidth_source = "made up"
[accel]
vrw_m_s_per_sqrt_hr = 0.06
vrw_source = "made up"
turn_on_bias_mg = 0.75
turn_on_bias_source = "made up"
in_run_bias_mg = 0.05
in_run_bias_source = "made up"
in_run_bias_tau_s = 1000.0
in_run_bias_tau_source = "made up"
scale_ppm = 300.0
scale_source = "made up"
misalignment_mrad = 1.0
misalignment_source = "made up"
range_g = 10.0
range_source = "made up"
)";

/// Of the first two seconds of simulated_imu(): it drives north-east from there.
constexpr const char* kFixes =
    "gps_week,sow,lat_deg,lon_deg,h_m,sd_n_m,sd_e_m,sd_u_m,vn,ve,vu,sd_vn,sd_ve,sd_vu,status\n"
    "1612,520200.5,45.00001,7.00001,200,3,3,5,1,1,0,0.1,0.1,0.2,single\n1612,520201,45.00002,7.00002,200,3,3,5,1,1,0,0."
    "1,0.1,"
    "0.2,single\n1612,520201.5,45.00003,7.00003,200,3,3,5,,,,,,,single\n1612,520201.75,,,,,,,,,,,,,none\n"
    "1612,520202,45.00004,7.00004,200,3,3,5,1,1,0,0.1,0.1,0.2,single\n";
constexpr const char* kKfGinsFixes =
    "520200.5 45.00001 7.00001 200 3 3 5\n520201 45.00002 7.00002 200 3 3 5\n520201.5 45.00003 7.00003 200 3 3 5\n";
constexpr const char* kRtklibFixes =
    "% program   : RTKLIB\n%  GPST            latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) "
    "sdeu(m) sdun(m) age(s) ratio\n2010/12/04 00:30:00.500 45.00001 7.00001 200.0 1 9 3.0 3.0 5.0 0 0 0 0 0\n"
    "2010/12/04 00:30:01.000 45.00002 7.00002 200.0 5 9 3.0 3.0 5.0 0 0 0 0 0\n";
constexpr const char* kWheel =
    "t_s,speed_kmh,ticks\n520200.2,5,1\n520200.4,5,14\n520200.6,5.5,28\n520200.8,5.5,42\n520201,6,56\n";
constexpr const char* kFuseToml = R"([fusion]
filter = "vehicle"
[imu]
sensor = "adis16465"
arw_deg_per_sqrt_hr = 0.2
turn_deg = [0.0, 0.5, 1.0]
clock_offset_s = 0.01
[gnss]
lever_m = [0.1, 0.0, 1.2]
[start]
from = "given"
place_deg_deg_m = [45.0, 7.0, 200.0]
[score]
skip_s = 0.5
[output]
rate_hz = 5.0
)";

std::vector<Companion> of_a_drive() {
  return with({simulated_imu()[0], simulated_imu()[2]}, {{"fixes.csv", kFixes}});
}

Format recorded(const std::string& name, const std::function<std::vector<Seed>()>& seeds) {
  return {.name = name,
          .command = {"imu", "simulate", "--trajectory", "@", "--duration", "1", "--rate", "20"},
          .read = {},
          .seeds = seeds};
}

}  // namespace

std::vector<Format> inertial_formats() {
  return {
      {.name = "ImuCsvAllan",
       .command = {"imu", "allan", "@", "--per-octave", "1"},
       .read = {},
       .seeds =
           [] { return with(resting(), excerpt("inertial/allan_mpu6050/mpu6050_static_655s.csv", "mpu.csv", 300)); }},
      {.name = "ImuCsvFit",
       .command = {"imu", "fit", "@", "--static", "--at", "45,7,200"},
       .read = {},
       .seeds = resting},
      {.name = "ImuCsvDeadReckon",
       .command = {"imu", "dead-reckon", "--imu", "@", "--truth", "truth.nav"},
       .read = {},
       .seeds = [] { return std::vector<Seed>{simulated_imu()[0]}; },
       .beside = [] { return std::vector<Companion>{simulated_imu()[2]}; }},
      {.name = "FuseFixes",
       .command = {"fuse", "--imu", "imu.csv", "--gnss", "@", "--truth", "truth.nav"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"fixes.csv", kFixes}, {"fixes.txt", kKfGinsFixes}, {"fixes.pos", kRtklibFixes}};
           },
       .beside = of_a_drive},
      {.name = "FuseImu",
       .command = {"fuse", "--imu", "@", "--gnss", "fixes.csv", "--truth", "truth.nav"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{simulated_imu()[0], simulated_imu()[1]};
           },
       .beside =
           [] {
             return std::vector<Companion>{simulated_imu()[2], {"fixes.csv", kFixes}};
           }},
      {.name = "FuseTruth",
       .command = {"fuse", "--imu", "imu.csv", "--gnss", "fixes.csv", "--truth", "@", "--outage", "0.5,1,0.2"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{simulated_imu()[2], {"truth.csv", kTruthCsv}};
           },
       .beside =
           [] {
             return std::vector<Companion>{simulated_imu()[0], {"fixes.csv", kFixes}};
           }},
      {.name = "FuseOdometer",
       .command = {"fuse", "--imu", "imu.csv", "--gnss", "fixes.csv", "--truth", "truth.nav", "--odometer", "@"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"wheel.csv", kWheel}};
           },
       .beside = of_a_drive},
      {.name = "FuseToml",
       .command = {"fuse", "--imu", "imu.csv", "--gnss", "fixes.csv", "--config", "@"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"fuse.toml", kFuseToml}};
           },
       .beside = of_a_drive},
      {.name = "KfGinsLog",
       .command = {"imu", "dead-reckon", "--imu", "@", "--truth", "truth.nav"},
       .read = {},
       .seeds = [] { return std::vector<Seed>{simulated_imu()[1]}; },
       .beside = [] { return std::vector<Companion>{simulated_imu()[2]}; }},
      {.name = "NavigationTruth",
       .command = {"imu", "dead-reckon", "--imu", "imu.csv", "--truth", "@"},
       .read = {},
       .seeds =
           [] {
             return with({simulated_imu()[2], {"truth.csv", kTruthCsv}},
                         excerpt("inertial/kfgins_gnss_only/KF-GINS-Matlab_dataset2_truth.nav", "real.nav", 60));
           },
       .beside = [] { return std::vector<Companion>{simulated_imu()[0]}; }},
      recorded("NavigationTrajectory",
               [] {
                 return std::vector<Seed>{simulated_imu()[2], {"truth.csv", kTruthCsv}};
               }),
      recorded("Tum",
               [] {
                 return std::vector<Seed>{{"drive.tum", kTum}};
               }),
      recorded("Kitti",
               [] {
                 return with({{"drive.kitti", kKitti}},
                             excerpt("lidar/ouster/OS-1-128_v2.3.0_1024x10_lb_n3_poses_kitti.txt", "real.kitti", 20));
               }),
      recorded("TrajectoryCsv",
               [] {
                 return std::vector<Seed>{{"drive.csv", kPoses}, {"low_nav.csv", kMissionPoses}};
               }),
      {.name = "SplinePoints",
       .command = {"imu", "simulate", "--points", "@", "--duration", "1", "--rate", "20"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"points.csv", kPoints}, {"posed.csv", kPointsWithAttitude}};
           }},
      {.name = "MotionToml",
       .command = {"imu", "simulate", "--path", "@", "--duration", "1"},
       .read = {},
       .seeds =
           [] {
             return std::vector<Seed>{{"motion.toml", kMotion}, {"circle.toml", kCircle}};
           }},
      {.name = "SensorToml",
       .command = {"imu", "simulate", "--sensor", "@", "--errors", "full", "--path", "stationary", "--duration", "1",
                   "--rate", "50"},
       .read = {},
       .seeds = [] {
         return std::vector<Seed>{{"mine.toml", kSensor}};
       }}};
}

}  // namespace canyon::testing
