#include "canyon/study/registration_error/scan_store.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "canyon/core/files/files.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/study/registration_error/forwarded_registration.h"

namespace canyon::study {
namespace {

/// [lidar] as far as the scanner has a part in it. It is made of this and nothing else, so that no key of it can be
/// missing where scans are told apart.
lidar::LidarConfig scanning_part(const mission::MissionConfig& config) {
  lidar::LidarConfig out = config.lidar;
  out.deskew = lidar::LidarConfig{}.deskew;
  return out;
}

template <class Config>
std::string text_of_all_keys(Config config) {
  return fields_as_json([&config](FieldVisitor& f) { visit(f, config); });
}

/// Whether no filter has a part in how scans are put straight.
bool put_straight_by_truth_or_not(const mission::MissionConfig& config) {
  const lidar::Deskewing by = lidar::deskewing(config.lidar.deskew);
  return config.run.truth_as_pose || by == lidar::Deskewing::kTruth || by == lidar::Deskewing::kNone;
}

bool same_poses(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const StampedPose& x, const StampedPose& y) {
    return x.t == y.t && x.X_WB.p == y.X_WB.p && x.X_WB.R.coeffs() == y.X_WB.R.coeffs();
  });
}

/// Place, normal, tilt, and the place again in a tree, with its share of the tree.
std::int64_t bytes_of(const lidar::PreparedCloud& cloud) {
  constexpr std::int64_t kPoint = 48;
  return kPoint * static_cast<std::int64_t>(cloud.points.size());
}

}  // namespace

struct ScanStore::Kept {
  LidarScan scan;
  std::vector<StampedPose> motion;  ///< true, as it was given
};

template <class Shelf>
typename Shelf::mapped_type ScanStore::find(const Shelf& shelf, const typename Shelf::key_type& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = shelf.find(key);
  return found == shelf.end() ? nullptr : found->second;
}

template <class Shelf, class Make>
void ScanStore::keep(Shelf& shelf, const typename Shelf::key_type& key, std::int64_t bytes, const Make& make) {
  {
    const std::lock_guard lock(mutex_);
    if (bytes > free_bytes_ || shelf.contains(key)) return;
    free_bytes_ -= bytes;
  }
  typename Shelf::mapped_type made = make();  // half a megabyte is copied: others need not wait
  const std::lock_guard lock(mutex_);
  if (!shelf.emplace(key, std::move(made)).second) free_bytes_ += bytes;
}

void ScanStore::count(std::int64_t Counts::*what) {
  const std::lock_guard lock(mutex_);
  ++(counts_.*what);
}

ScanStore::Counts ScanStore::counts() const {
  const std::lock_guard lock(mutex_);
  Counts out = counts_;
  out.kept_bytes = most_bytes_ - free_bytes_;
  return out;
}

class ScanStore::KeepingScanner final : public lidar::Scanner {
 public:
  KeepingScanner(std::unique_ptr<lidar::Scanner> scanner, ScanStore& store, Scans& scans)
      : scanner_(std::move(scanner)), store_(store), scans_(scans) {}

  void scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
            const InstancesAt& moving, lidar::LidarOutput& out) override {
    const auto kept = whole_ ? store_.find(scans_, index) : nullptr;
    if (kept && kept->scan.t == t && same_poses(kept->motion, truth.poses())) {
      out.scan = kept->scan;
      store_.count(&Counts::scans_taken);
    } else {
      scanner_->scan(index, t, truth, scene, moving, out);
      store_.count(&Counts::scans_made);
      if (whole_) keep_scan(index, out.scan, truth.poses());
    }
    out.truth.clear();
  }
  void true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
                   std::vector<float>& out) override {
    scanner_->true_ranges(index, t, truth, scene, out);
  }
  double reach_s(std::int64_t index) const override { return scanner_->reach_s(index); }
  void keep(const lidar::KeptRoom* room) override {
    whole_ = room == nullptr;
    scanner_->keep(room);
  }
  std::int64_t rays() const override { return scanner_->rays(); }

 private:
  void keep_scan(std::int64_t index, const LidarScan& scan, const std::vector<StampedPose>& motion) {
    const std::size_t bytes = scan.points.size() * sizeof(LidarPoint) + motion.size() * sizeof(StampedPose);
    store_.keep(scans_, index, static_cast<std::int64_t>(bytes), [&] {
      return std::make_shared<const Kept>(Kept{scan, motion});
    });
  }

  std::unique_ptr<lidar::Scanner> scanner_;
  ScanStore& store_;
  Scans& scans_;
  bool whole_ = true;  ///< its readers keep all of a scan
};

class ScanStore::KeepingRegistration final : public ForwardedRegistration {
 public:
  KeepingRegistration(std::unique_ptr<lidar::Registration> method, ScanStore& store, Clouds& clouds)
      : ForwardedRegistration(std::move(method)), store_(store), clouds_(clouds) {}

  std::shared_ptr<const lidar::PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const override {
    static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
    const std::string key =
        sha256_hex(std::string_view(reinterpret_cast<const char*>(points.data()), points.size_bytes()));
    if (auto kept = store_.find(clouds_, key)) {
      store_.count(&Counts::clouds_taken);
      return kept;
    }
    auto cloud = method().prepare(points);
    store_.keep(clouds_, key, bytes_of(*cloud), [&] { return cloud; });
    return cloud;
  }

 private:
  ScanStore& store_;
  Clouds& clouds_;
};

Result<std::unique_ptr<lidar::Scanner>> ScanStore::scanner(const mission::MissionConfig& config) {
  const lidar::LidarConfig part = scanning_part(config);
  const std::string seed = std::to_string(config.run.seed);
  CANYON_TRY(auto made, lidar::make_scanner(part, static_cast<std::uint64_t>(config.run.seed)));
  const std::lock_guard lock(mutex_);
  return std::unique_ptr<lidar::Scanner>(
      std::make_unique<KeepingScanner>(std::move(made), *this, scans_[seed + text_of_all_keys(part)]));
}

Result<std::unique_ptr<lidar::Registration>> ScanStore::registration(const mission::MissionConfig& config) {
  CANYON_TRY(auto made, lidar::make_registration(config.registration));
  if (!put_straight_by_truth_or_not(config)) return made;
  const std::lock_guard lock(mutex_);
  return std::unique_ptr<lidar::Registration>(
      std::make_unique<KeepingRegistration>(std::move(made), *this, clouds_[text_of_all_keys(config.registration)]));
}

}  // namespace canyon::study
