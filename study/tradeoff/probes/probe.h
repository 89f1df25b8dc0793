#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/model_table.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/tradeoff/ladders/config_keys.h"

namespace canyon::study {

/// What a model gave: for each sample (epoch, scan, window, keyframe) values of which every `dimension` consecutive
/// ones are one vector, or NaN where there is none. Rungs of a ladder have the same layout, so that value stands beside
/// value. Where a probe knows the truth the values are errors against it.
struct Samples {
  std::size_t dimension = 1;
  std::vector<std::vector<double>> values;
  /// What each vector is of (a surface), where that matters: two of different things are no difference. Empty: all are.
  std::vector<std::vector<std::uint32_t>> of{};
};

/// One repetition.
struct ProbeRun {
  Samples samples;
  double cpu_s = 0.0;        ///< of what is measured alone, all threads
  double simulated_s = 1.0;  ///< time of a mission that this stands for
  std::int64_t work = 0;     ///< counted operations; the same bits for any threads
  double memory_mb = 0.0;    ///< heap that the model and its answers hold at the end
};

/// A rung of a ladder, made ready: what is not its own cost (scene, truth, inputs) was made before.
class Probe {
 public:
  virtual ~Probe() = default;
  virtual Result<ProbeRun> run() = 0;
};

struct RecordedDrive;  // study/tradeoff/recorded/recorded_drive.h

/// What probes are made from. All of it must outlive the probe.
struct ProbeSetup {
  const mission::MissionConfig& config;
  const mission::PreparedMission& mission;
  const Tape& tape;
  std::size_t samples;
  const std::map<std::string, std::string>& own;  ///< settings of probe_keys()
  const RecordedDrive* recording = nullptr;       ///< for the probes on one

  double own_number(const std::string& key) const;  ///< NaN if it is not set
  GpsTime time_of(double t_s) const { return mission.start + t_s; }
};

/// One row of the table of probes.
struct ProbeModel {
  Result<std::unique_ptr<Probe>> (*make)(const ProbeSetup& setup);
  const char* unit;
  const char* work;          ///< what is counted
  bool knows_truth = false;  ///< its values are errors
  double rounding = 0.0;     ///< differences below this are rounding: no order is read off them
  bool has_steps = false;    ///< the ladder's numbers are steps or rates of a scheme on smooth motion without noise
  /// Theoretical order of the row that the ladder is of; none where there is no theory.
  std::optional<double> (*order)(const std::map<std::string, std::string>& own,
                                 const mission::MissionConfig& config) = nullptr;
};
ModelTable<ProbeModel> probes();

/// Keys of ladders that are no mission's: "strapdown.rate_hz", "mems.integrator".
std::vector<ConfigKey> probe_keys();

/// So many places in [margin_s, duration - margin_s] of a tape, evenly spread, each at a tick of `rate_hz`, none twice.
std::vector<std::int64_t> spread_ticks(const ProbeSetup& setup, double rate_hz, double margin_s);

}  // namespace canyon::study
