#include <cstdio>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/apps/options/lidar_drive.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/lidar/files/scan_files.h"
#include "canyon/lidar/velodyne/packet_output.h"

namespace canyon::apps {

namespace {

using lidar::velodyne::PacketOutput;

struct Options {
  CommonOptions common;
  LidarDriveOptions drive;
  std::string format = "pcd", frame = "sensor", out, pcap, udp;
  std::int64_t seed = 1;
  bool force = false, udp_fast = false;
};

/// `capture`: the file asked for, or none.
Result<std::optional<PacketOutput>> packet_output(const Options& options, const lidar::LidarConfig& config,
                                                  StagedFile* capture) {
  if (options.pcap.empty() && options.udp.empty()) return std::optional<PacketOutput>();
  CANYON_TRY(PacketOutput out, PacketOutput::create(config));
  if (!options.udp.empty()) {
    const auto colon = options.udp.find(':');
    CANYON_TRY(const auto port, parse_numbers(colon == std::string::npos ? "2368" : options.udp.substr(colon + 1), 1,
                                              "--udp", "ADDRESS or ADDRESS:PORT"));
    if (!(port[0] >= 1 && port[0] <= 65535))
      return Error{"--udp", 0, "", '"' + options.udp + '"', "a port from 1 to 65535"};
    CANYON_TRY(auto sender,
               lidar::velodyne::UdpSender::open(options.udp.substr(0, colon), static_cast<std::uint16_t>(port[0])));
    out.send_to(std::move(sender), options.udp_fast);
  }
  if (capture != nullptr) CANYON_TRY_STATUS(out.capture_to(*capture));
  return std::optional(std::move(out));
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const lidar::CloudFormat* format, lidar::cloud_format(options.format, "--format"));
  CANYON_TRY(const lidar::ScanDrive drive, lidar_drive(options.drive));
  OutputSet outputs(options.force);
  CANYON_TRY(const StagedDirectory* const staged, outputs.directory(options.out));
  CANYON_TRY(StagedFile* const capture, outputs.file(options.pcap));
  CANYON_TRY(auto packets, packet_output(options, drive.lidar, capture));
  Progress progress("scans", static_cast<double>(drive.scans), !options.common.json);
  const auto take = [&](std::int64_t k, GpsTime t, const lidar::LidarOutput& output,
                        const scene::SceneAt& scene) -> Status {
    if (packets) CANYON_TRY_STATUS(packets->add(k, output.scan));
    if (staged != nullptr) {
      const std::string stem = staged->staging_path() + printed("/scan_%06lld", static_cast<long long>(k));
      const auto points = options.frame == "sensor" ? output.scan.points : points_in_scene(drive, output.scan);
      CANYON_TRY_STATUS(write_text_file(stem + "." + format->name, format->text(t, points)));
      CANYON_TRY_STATUS(write_text_file(stem + "_truth.csv", lidar::truth_csv(output.truth, scene)));
    }
    progress.advance(1);
    return Ok{};
  };
  CANYON_TRY(const lidar::ScanDriveCost cost, lidar::scan_drive(drive, static_cast<std::uint64_t>(options.seed), take));
  if (staged != nullptr) CANYON_TRY_STATUS(write_tum(staged->staging_path() + "/trajectory.tum", drive.motion));
  CANYON_TRY_STATUS(outputs.commit());
  const std::int64_t packets_sent = packets ? packets->packets() : 0;
  if (options.common.json) {
    const Json out{{"scans", drive.scans},
                   {"rays", cost.rays},
                   {"points", cost.points},
                   {"packets", packets_sent},
                   {"start", drive.start.iso(9)},
                   {"rate_hz", drive.lidar.rate_hz},
                   {"beams", drive.lidar.beams},
                   {"model", drive.lidar.model.name},
                   {"timing",
                    {{"scanning_s", cost.scanning_s},
                     {"ms_per_scan", 1e3 * cost.scanning_s / static_cast<double>(drive.scans)},
                     {"million_rays_per_s", 1e-6 * static_cast<double>(cost.rays) / cost.scanning_s}}}};
    std::printf("%s\n", json_text(out).c_str());
    return 0;
  }
  std::printf("%lld scans with %s, %s: %lld rays, %lld points\n", static_cast<long long>(drive.scans),
              drive.lidar.beams.c_str(), drive.lidar.model.name.c_str(), static_cast<long long>(cost.rays),
              static_cast<long long>(cost.points));
  std::printf("Scanned in %.3f s: %.2f ms per scan, %.1f million rays per second\n", cost.scanning_s,
              1e3 * cost.scanning_s / static_cast<double>(drive.scans),
              1e-6 * static_cast<double>(cost.rays) / cost.scanning_s);
  if (packets_sent > 0) std::printf("%lld packets\n", static_cast<long long>(packets_sent));
  if (staged != nullptr)
    std::printf("Files: %s/{scan_NNNNNN.%s, scan_NNNNNN_truth.csv, trajectory.tum}\n", staged->final_path().c_str(),
                format->name);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  declare_lidar_drive(arguments, options->drive);
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
    if (options->drive.at.empty() && options->drive.trajectory.empty())
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
