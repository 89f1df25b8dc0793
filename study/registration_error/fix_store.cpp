#include "canyon/study/registration_error/fix_store.h"

#include <utility>

#include "canyon/core/check.h"
#include "canyon/study/registration_error/error_sources.h"

namespace canyon::study {

/// Hands on what a sensor measures, and keeps it. What it has kept when it goes is that of a whole run, as runs on one
/// tape are equally long.
class FixStore::Recording final : public gnss::GnssSensor {
 public:
  Recording(std::unique_ptr<gnss::GnssSensor> sensor, FixStore& store, std::string receiver)
      : sensor_(std::move(sensor)),
        store_(store),
        receiver_(std::move(receiver)),
        recorded_(std::make_shared<Recorded>()) {
    recorded_->has_satellites = sensor_->has_satellites();
  }
  ~Recording() override { store_.keep(receiver_, std::move(recorded_)); }

  gnss::GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                           const scene::SceneAt& scene) override {
    auto& epochs = recorded_->epochs;
    if (epochs.empty()) recorded_->first = index;
    CANYON_CHECK(index == recorded_->first + static_cast<std::int64_t>(epochs.size()), "epoch ", index, " after ",
                 epochs.size(), " from ", recorded_->first);
    epochs.push_back(sensor_->measure(index, t, p_A_W, v_A_W, scene));
    return epochs.back();
  }
  gnss::GnssCounters counters() const override { return sensor_->counters(); }
  bool has_satellites() const override { return recorded_->has_satellites; }
  std::vector<std::string> warnings() const override { return sensor_->warnings(); }

 private:
  std::unique_ptr<gnss::GnssSensor> sensor_;
  FixStore& store_;
  std::string receiver_;
  std::shared_ptr<Recorded> recorded_;
};

class FixStore::Replaying final : public gnss::GnssSensor {
 public:
  explicit Replaying(std::shared_ptr<const Recorded> recorded) : recorded_(std::move(recorded)) {}
  gnss::GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d&, const Eigen::Vector3d&,
                           const scene::SceneAt&) override {
    const auto& epochs = recorded_->epochs;
    const std::int64_t at = index - recorded_->first;
    CANYON_CHECK(at >= 0 && at < static_cast<std::int64_t>(epochs.size()), "epoch ", index, " of ", epochs.size(),
                 " from ", recorded_->first);
    const gnss::GnssOutput& out = epochs[static_cast<std::size_t>(at)];
    CANYON_CHECK(out.truth.t == t, "epoch ", index, " was measured at ", out.truth.t.iso(), ", not ", t.iso());
    return out;
  }
  gnss::GnssCounters counters() const override { return {}; }
  bool has_satellites() const override { return recorded_->has_satellites; }

 private:
  std::shared_ptr<const Recorded> recorded_;
};

Result<std::unique_ptr<gnss::GnssSensor>> FixStore::sensor(const mission::MissionConfig& config,
                                                           const mission::PreparedMission& mission, GpsTime end) {
  std::string receiver = gnss_text(config);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = recorded_.find(receiver); found != recorded_.end())
      return std::unique_ptr<gnss::GnssSensor>(std::make_unique<Replaying>(found->second));
  }
  CANYON_TRY(auto sensor, gnss::make_gnss_sensor(config.gnss, static_cast<std::uint64_t>(config.run.seed),
                                                 mission.start, end, *mission.scene));
  return std::unique_ptr<gnss::GnssSensor>(std::make_unique<Recording>(std::move(sensor), *this, std::move(receiver)));
}

void FixStore::keep(const std::string& receiver, std::shared_ptr<const Recorded> recorded) {
  const std::lock_guard lock(mutex_);
  ++measured_;
  recorded_.emplace(receiver, std::move(recorded));
}

int FixStore::measured() const {
  const std::lock_guard lock(mutex_);
  return measured_;
}

}  // namespace canyon::study
