#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "canyon/gnss/sensor/sensor.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// What receivers measured along one tape, by configuration: of runs whose receivers do not differ only the first
/// searches for paths. Thread-safe; who comes while the first still drives measures for himself, to the same bits.
class FixStore {
 public:
  /// A sensor for a run of this configuration on the store's tape, which ends at `end`.
  Result<std::unique_ptr<gnss::GnssSensor>> sensor(const mission::MissionConfig& config,
                                                   const mission::PreparedMission& mission, GpsTime end);
  /// Receivers that measured.
  int measured() const;

 private:
  struct Recorded {
    std::vector<gnss::GnssOutput> epochs;
    std::int64_t first = 0;  ///< index of the first epoch
    bool has_satellites = false;
  };
  class Recording;
  class Replaying;
  void keep(const std::string& receiver, std::shared_ptr<const Recorded> recorded);

  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const Recorded>> recorded_;
  int measured_ = 0;
};

}  // namespace canyon::study
