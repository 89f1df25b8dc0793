#include "canyon/mission/stress/runs/heard_run.h"

#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/mission/stress/open_street.h"

namespace canyon::mission {
namespace {

class Listener final : public Autonomy {
 public:
  Listener(HeardRun& run, HeardRun::Says says) : run_(run), says_(std::move(says)) {}

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    run_.events.push_back({Heard::kSeen, scan.t});
    run_.scans.push_back(scan), run_.seen_from.push_back(X_WL), run_.seen.push_back(estimate);
  }
  void count(const OdometerSample& sample) override { run_.events.push_back({Heard::kCounted, sample.t}); }
  bool looks() const override { return says_.looks; }
  DriveCommand drive(const NavEstimate& estimate) override {
    run_.events.push_back({Heard::kAsked, estimate.t});
    run_.asked.push_back(estimate);
    run_.given.push_back(says_.drives(asked_++));
    return run_.given.back();
  }
  AutonomyState state() const override { return says_.is ? says_.is(asked_) : AutonomyState::kDriving; }
  int next_waypoint() const override { return says_.next_waypoint; }

 private:
  HeardRun& run_;
  HeardRun::Says says_;
  int asked_ = 0;
};

class Heeder final : public Recorder {
 public:
  explicit Heeder(HeardRun& run) : run_(run) {}

  Status imu(const ImuSample& sample) override { return heard(Heard::kImu, sample.t); }
  Status odometer(const inertial::Odometer::Reading& r) override { return heard(Heard::kOdometer, r.message.t); }
  Status barometer(const inertial::Barometer::Reading& r) override { return heard(Heard::kBarometer, r.message.t); }
  Status magnetometer(const inertial::Magnetometer::Reading& r) override {
    return heard(Heard::kMagnetometer, r.message.t);
  }
  Status gnss(const GnssRow& row) override {
    run_.fixes.push_back(row);
    return heard(Heard::kFix, row.fix.t);
  }
  Status epoch(const NavRow& row) override {
    run_.rows.push_back(row);
    return heard(Heard::kEpoch, row.t);
  }
  Status node(const TapeNode& node) override {
    run_.nodes.push_back(node);
    return Ok{};
  }

 private:
  Status heard(Heard what, GpsTime t) {
    run_.events.push_back({what, t});
    return Ok{};
  }
  HeardRun& run_;
};

}  // namespace

std::unique_ptr<HeardRun> heard_run(const std::string& keys, const HeardRun::Says& says, const Tape* tape,
                                    const Omissions* omissions) {
  static SceneCache scenes;
  auto out = std::make_unique<HeardRun>();
  auto file = MissionFile::parse(kOpenStreet, "open.toml");
  CANYON_CHECK(file.ok(), file.ok() ? "" : file.error().str());
  auto config = file->resolve("low");
  CANYON_CHECK(config.ok(), config.ok() ? "" : config.error().str());
  out->config = *config;
  const auto tree = ConfigNode::parse(keys, "keys.toml");
  CANYON_CHECK(tree.ok(), tree.ok() ? "" : tree.error().str());
  const Status read = read_config(&*tree, "", out->config);
  CANYON_CHECK(read.ok(), read.ok() ? "" : read.error().str());
  auto mission = prepare(out->config, scenes);
  CANYON_CHECK(mission.ok(), mission.ok() ? "" : mission.error().str());
  out->mission = *std::move(mission);
  Heeder heeder(*out);
  RunParts parts{.tape = tape, .recorder = &heeder, .autonomy = std::make_unique<Listener>(*out, says)};
  parts.omissions = omissions;
  auto record = run_mission(out->config, out->mission, nullptr, std::move(parts));
  CANYON_CHECK(record.ok(), record.ok() ? "" : record.error().str());
  out->record = *std::move(record);
  return out;
}

}  // namespace canyon::mission
