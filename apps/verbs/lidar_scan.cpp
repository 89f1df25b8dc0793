#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/apps/options/scene_options.h"
#include "canyon/core/files/files.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/lidar/files/scan_files.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/velodyne/packet_writer.h"
#include "canyon/lidar/velodyne/pcap.h"
#include "canyon/lidar/velodyne/udp_sender.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene{.scene = mission::kDefaultMission, .from = {}};
  std::string fidelity = "high";
  std::string at, trajectory, beams, model, detector, returns, see_through;
  std::string format = "pcd", frame = "sensor", start, out, pcap, udp;
  std::optional<double> rate_hz;
  std::optional<std::int64_t> azimuth_steps;
  std::int64_t seed = 1, scans = 1;
  bool force = false, udp_fast = false;
};

std::string text(const char* format, auto... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// What to scan with, where, and along which way.
struct Setup {
  lidar::LidarConfig lidar;
  std::shared_ptr<const scene::Scene> scene;
  scene::Traffic traffic;
  GpsTime traffic_start;
  GpsTime start;  ///< stamp of the first scan
  Trajectory motion;
  std::int64_t scans = 1;
};

/// A pose from --at X,Y,Z_ABOVE_GROUND,YAW, standing.
Result<Trajectory> standing(const Options& options, const scene::Scene& scene, GpsTime start, double seconds) {
  CANYON_TRY(const auto v, parse_numbers(options.at, 4, "--at",
                                         "X,Y,H,YAW: metres in the scene, metres above ground, degrees from east"));
  const auto ground = scene.ground(v[0], v[1]);
  if (!ground) return Error{"--at", 0, "", '"' + options.at + "\" lies outside the scene", "a place over its terrain"};
  const Pose X_WB{rotation_from({.yaw_rad = v[3] * kDegree}), {v[0], v[1], ground->height_m + v[2]}};
  return Trajectory({{start - seconds, X_WB}, {start + seconds, X_WB}});
}

Result<Trajectory> read_trajectory(const std::string& path) {
  return path.ends_with(".csv") ? read_csv_trajectory(path) : read_tum(path);
}

Result<Setup> setup_of(const Options& options) {
  // A scene by itself is scanned with the built-in mission's LIDAR.
  const bool mission_file = options.scene.scene.ends_with(".toml");
  CANYON_TRY(auto file, mission::MissionFile::load(mission_file ? options.scene.scene : ""));
  const auto set = [&file](const char* key, const std::string& value, const char* option) {
    if (!value.empty()) file.set_option(key, ConfigNode::of(value), option);
  };
  set("lidar.beams", options.beams, "--beams");
  set("lidar.model", options.model, "--model");
  set("lidar.detector", options.detector, "--detector");
  set("lidar.returns", options.returns, "--returns");
  set("lidar.see_through", options.see_through, "--see-through");
  set("time.start", options.start, "--start");
  if (options.rate_hz) file.set_option("lidar.rate_hz", ConfigNode::of(*options.rate_hz), "--rate");
  if (options.azimuth_steps)
    file.set_option("lidar.azimuth_steps", ConfigNode::of(*options.azimuth_steps), "--azimuth-steps");
  CANYON_TRY_STATUS(file.check_fidelities({options.fidelity}, "--fidelity"));
  CANYON_TRY(const mission::MissionConfig config, file.resolve(options.fidelity));
  Setup out;
  out.lidar = config.lidar;
  const auto start = mission::start_time(config);
  if (!start) return file.locate(start.error(), options.fidelity);
  if (const auto scanner = lidar::make_scanner(out.lidar, 1); !scanner)
    return file.locate(scanner.error(), options.fidelity);
  mission::SceneCache scenes;
  CANYON_TRY(const scene::SceneConfig scene, scene_config(options.scene));
  CANYON_TRY(out.scene, scenes.get(scene));
  CANYON_TRY(out.traffic, scene::Traffic::make(scene.moving, *out.scene));
  out.traffic_start = *start;
  const double period_s = 1.0 / out.lidar.rate_hz;
  // Lasers that run free begin a scan up to one cycle, below 1 ms, before its period.
  const double before_s = period_s + out.lidar.latency_s + 1e-3;
  if (options.trajectory.empty()) {
    out.start = *start;
    out.scans = options.scans;
    CANYON_TRY(out.motion,
               standing(options, *out.scene, *start, before_s + static_cast<double>(options.scans) * period_s));
    return out;
  }
  CANYON_TRY(out.motion, read_trajectory(options.trajectory));
  const auto& poses = out.motion.poses();
  out.start = poses.front().t + before_s;
  out.scans = static_cast<std::int64_t>(std::floor((poses.back().t - out.start) / period_s + 1e-9)) + 1;
  if (out.scans < 1)
    return Error{options.trajectory, 0, "", text("covers %.3f s", poses.back().t - poses.front().t),
                 text("at least one revolution, %.3f s", before_s)};
  return out;
}

/// Where the packets go: a capture, the network, or nowhere.
struct PacketOutput {
  std::optional<lidar::velodyne::PacketWriter> writer;
  std::optional<lidar::velodyne::UdpSender> udp;
  std::optional<lidar::velodyne::PcapWriter> capture;
  bool fast = false;  ///< as fast as possible, not at the sensor's pace
  std::optional<GpsTime> first;
  std::int64_t packets = 0;

  Status add(std::int64_t index, const LidarScan& scan) {
    if (!writer) return Ok{};
    for (const auto& p : writer->add(index, scan)) {
      const std::string bytes = p.packet.bytes();
      ++packets;
      if (!first) first = p.t;
      if (udp) CANYON_TRY_STATUS(fast ? udp->send(bytes) : udp->send_at(bytes, p.t - *first));
      if (!capture) continue;
      constexpr std::int64_t kGpsEpochInUnix_us = 315'964'800'000'000;
      const std::int64_t unix_us = p.t.ns / 1000 - p.t.leap_seconds() * 1'000'000 + kGpsEpochInUnix_us;
      CANYON_TRY_STATUS(capture->add({unix_us, lidar::velodyne::Packet::kPort, bytes}));
    }
    return Ok{};
  }
};

/// `capture`: the file asked for, or none.
Result<PacketOutput> packet_output(const Options& options, const lidar::LidarConfig& config, StagedFile* capture) {
  PacketOutput out;
  out.fast = options.udp_fast;
  if (options.pcap.empty() && options.udp.empty()) return out;
  CANYON_TRY(out.writer, lidar::velodyne::PacketWriter::create(config));
  if (!options.udp.empty()) {
    const auto colon = options.udp.find(':');
    CANYON_TRY(const auto port, parse_numbers(colon == std::string::npos ? "2368" : options.udp.substr(colon + 1), 1,
                                              "--udp", "ADDRESS or ADDRESS:PORT"));
    if (!(port[0] >= 1 && port[0] <= 65535))
      return Error{"--udp", 0, "", '"' + options.udp + '"', "a port from 1 to 65535"};
    CANYON_TRY(auto sender,
               lidar::velodyne::UdpSender::open(options.udp.substr(0, colon), static_cast<std::uint16_t>(port[0])));
    out.udp.emplace(std::move(sender));
  }
  if (capture != nullptr) {
    CANYON_TRY(out.capture, lidar::velodyne::PcapWriter::begin(*capture));
  }
  return out;
}

/// The points in W, each from where the sensor was when it fired, or as the sensor gives them.
std::vector<LidarPoint> in_frame(const Options& options, const Setup& setup, const LidarScan& scan) {
  if (options.frame == "sensor") return scan.points;
  const Pose X_BL = lidar::sensor_in_body(setup.lidar);
  std::vector<LidarPoint> points = scan.points;
  for (LidarPoint& p : points) {
    const auto X_WB = setup.motion.at(scan.t - setup.lidar.latency_s + double{p.time_s});
    const Eigen::Vector3d p_W = *X_WB * X_BL * Eigen::Vector3d(p.x, p.y, p.z);
    p.x = static_cast<float>(p_W.x()), p.y = static_cast<float>(p_W.y()), p.z = static_cast<float>(p_W.z());
  }
  return points;
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const lidar::CloudFormat* format, lidar::cloud_format(options.format, "--format"));
  CANYON_TRY(const Setup setup, setup_of(options));
  CANYON_TRY(const auto scanner, lidar::make_scanner(setup.lidar, static_cast<std::uint64_t>(options.seed)));
  OutputSet outputs(options.force);
  CANYON_TRY(const StagedDirectory* const staged, outputs.directory(options.out));
  CANYON_TRY(StagedFile* const capture, outputs.file(options.pcap));
  CANYON_TRY(PacketOutput packets, packet_output(options, setup.lidar, capture));
  scene::SceneAt scene(*setup.scene);
  std::int64_t points = 0;
  double scanning_s = 0.0;
  lidar::LidarOutput output;
  Progress progress("scans", static_cast<double>(setup.scans), !options.common.json);
  for (std::int64_t k = 0; k < setup.scans; ++k) {
    throw_if_cancelled();
    const GpsTime t = setup.start + static_cast<double>(k) / setup.lidar.rate_hz;
    const double traffic_s = t - setup.traffic_start;
    lidar::Scanner::InstancesAt moving;
    if (!setup.traffic.empty()) {
      scene.set_instances(setup.traffic.at(traffic_s));
      moving = [&](double after_s) { return setup.traffic.at(traffic_s + after_s); };
    }
    const auto begin = std::chrono::steady_clock::now();
    scanner->scan(k, t, setup.motion, scene, moving, output);
    scanning_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    points += static_cast<std::int64_t>(output.scan.points.size());
    CANYON_TRY_STATUS(packets.add(k, output.scan));
    if (staged != nullptr) {
      const std::string stem = staged->staging_path() + text("/scan_%06lld", static_cast<long long>(k));
      CANYON_TRY_STATUS(
          write_text_file(stem + "." + format->name, format->text(t, in_frame(options, setup, output.scan))));
      CANYON_TRY_STATUS(write_text_file(stem + "_truth.csv", lidar::truth_csv(output.truth, scene)));
    }
    progress.advance(1);
  }
  if (staged != nullptr) CANYON_TRY_STATUS(write_tum(staged->staging_path() + "/trajectory.tum", setup.motion));
  CANYON_TRY_STATUS(outputs.commit());
  if (options.common.json) {
    const Json out{{"scans", setup.scans},
                   {"rays", scanner->rays()},
                   {"points", points},
                   {"packets", packets.packets},
                   {"start", setup.start.iso(9)},
                   {"rate_hz", setup.lidar.rate_hz},
                   {"beams", setup.lidar.beams},
                   {"model", setup.lidar.model},
                   {"timing",
                    {{"scanning_s", scanning_s},
                     {"ms_per_scan", 1e3 * scanning_s / static_cast<double>(setup.scans)},
                     {"million_rays_per_s", 1e-6 * static_cast<double>(scanner->rays()) / scanning_s}}}};
    std::printf("%s\n", out.dump().c_str());
    return 0;
  }
  std::printf("%lld scans with %s, %s: %lld rays, %lld points\n", static_cast<long long>(setup.scans),
              setup.lidar.beams.c_str(), setup.lidar.model.c_str(), static_cast<long long>(scanner->rays()),
              static_cast<long long>(points));
  std::printf("Scanned in %.3f s: %.2f ms per scan, %.1f million rays per second\n", scanning_s,
              1e3 * scanning_s / static_cast<double>(setup.scans),
              1e-6 * static_cast<double>(scanner->rays()) / scanning_s);
  if (packets.packets > 0) std::printf("%lld packets\n", static_cast<long long>(packets.packets));
  if (staged != nullptr)
    std::printf("Files: %s/{scan_NNNNNN.%s, scan_NNNNNN_truth.csv, trajectory.tum}\n", staged->final_path().c_str(),
                format->name);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("--scene", options->scene.scene,
              "a mission file's scene and LIDAR, a scene file, or \"vicksburg\" (built in)")
      .default_shown();
  declare_import_options(arguments, options->scene.from);
  arguments.option("--fidelity", options->fidelity, "whose LIDAR: low, paper, high, or one of the mission file's own")
      .default_shown();
  const auto at = arguments.option("--at", options->at,
                                   "X,Y,H,YAW of the vehicle: metres in the scene, metres above ground, degrees");
  const auto trajectory = arguments.option("--trajectory", options->trajectory,
                                           "drive along poses of the vehicle in the scene (TUM, or .csv)");
  at.excludes(trajectory);
  arguments.option("--scans", options->scans, "with --at: how many revolutions")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1'000'000});
  arguments.option("--beams", options->beams, "beam table; all [lidar] keys can be set in the mission file");
  arguments.option("--model", options->model, "single_ray or footprint");
  arguments.option("--detector", options->detector, "ideal or radiometric");
  arguments.option("--returns", options->returns, "strongest, first, last, dual or all");
  arguments.option("--see-through", options->see_through, "what light goes on behind: nothing, glass, leaves or both");
  arguments.option("--rate", options->rate_hz, "revolutions per second");
  arguments.option("--azimuth-steps", options->azimuth_steps, "firings per revolution; 0 = as fast as the lasers can");
  arguments.option("--start", options->start, "stamp of the first scan, with --at");
  arguments.option("--seed", options->seed, "seed of every random stream")
      .default_shown()
      .within(std::int64_t{0}, kLargestSeed);
  arguments.option("--format", options->format, "of the clouds: pcd, ply or las").default_shown();
  arguments
      .option("--frame", options->frame, "of the clouds: sensor (as measured) or scene (placed with the true motion)")
      .default_shown()
      .among({"sensor", "scene"});
  arguments.option("--pcap", options->pcap, "write the sensor's packets as a capture (vlp16, hdl32e)");
  arguments.option("--udp", options->udp, "send the sensor's packets to ADDRESS[:PORT], at the sensor's own pace");
  arguments.flag("--udp-fast", options->udp_fast, "send them as fast as they are made");
  arguments.option("--out", options->out, "directory for clouds and truth; without it only the summary is printed");
  arguments.flag("--force", options->force, "replace the capture, and the directory if canyon wrote it or it is empty");
  return [options]() -> Result<int> {
    if (options->at.empty() && options->trajectory.empty())
      return Error{"", 0, "command line", "no place given", "--at X,Y,H,YAW or --trajectory FILE"};
    return run(*options);
  };
}

}  // namespace

Verb lidar_scan_verb() {
  return {"lidar scan", "scans from a place or along a drive, as clouds with their truth or as the sensor's packets",
          "canyon lidar scan --at 120,-40,0,90 --beams os1_64 --azimuth-steps 1024 --model footprint --out scan",
          declare};
}

}  // namespace canyon::apps
