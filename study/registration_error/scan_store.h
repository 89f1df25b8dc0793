#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::study {

/// What LIDARs measured along one tape, and clouds that were made ready for registration, by what they depend on: of
/// runs that do not differ in it only the first makes them. All runs are of one mission, with its scene and traffic.
///
/// What comes first is kept, until it is `most_bytes` together; the rest each run makes for itself. Thread-safe; who
/// comes while the first still works makes it for himself. To the same bits in either case.
class ScanStore {
 public:
  /// `most_bytes` >= 0; 0: nothing is kept.
  explicit ScanStore(std::int64_t most_bytes) : free_bytes_(most_bytes), most_bytes_(most_bytes) {}

  /// The LIDAR of a run of this configuration. A scan is one that was kept if [lidar] but for `deskew`, the seed, the
  /// revolution, its stamp and the true motion given are the same. Without truth of its returns: on a tape nobody reads
  /// it. Must not outlive the store.
  Result<std::unique_ptr<lidar::Scanner>> scanner(const mission::MissionConfig& config);
  /// Its registration. A cloud is one that was kept if [registration] and the points are the same. Where scans are put
  /// straight by the filter's motion nothing is kept: hardly two runs have the same. Must not outlive the store.
  Result<std::unique_ptr<lidar::Registration>> registration(const mission::MissionConfig& config);

  struct Counts {
    std::int64_t scans_made = 0;    ///< by scanning
    std::int64_t scans_taken = 0;   ///< of what was kept
    std::int64_t clouds_taken = 0;  ///< likewise
    std::int64_t kept_bytes = 0;
  };
  Counts counts() const;

 private:
  class KeepingScanner;
  class KeepingRegistration;
  struct Kept;
  using Scans = std::map<std::int64_t, std::shared_ptr<const Kept>>;                  // by revolution
  using Clouds = std::map<std::string, std::shared_ptr<const lidar::PreparedCloud>>;  // by the points' SHA-256

  template <class Shelf>
  typename Shelf::mapped_type find(const Shelf& shelf, const typename Shelf::key_type& key) const;
  template <class Shelf, class Make>
  void keep(Shelf& shelf, const typename Shelf::key_type& key, std::int64_t bytes, const Make& make);
  void count(std::int64_t Counts::*what);

  mutable std::mutex mutex_;
  std::map<std::string, Scans> scans_;    // by what they depend on beside the true motion
  std::map<std::string, Clouds> clouds_;  // by how they are prepared
  std::int64_t free_bytes_;
  const std::int64_t most_bytes_;
  Counts counts_;
};

}  // namespace canyon::study
