#include "canyon/core/check.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/random/random.h"
#include "canyon/gnss/sensor/sensor_models.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

struct IsotropicParameters {
  double min_m = 0.3;
  double max_m = 0.5;
  double sigma_m = 0.23;  ///< what the fix claims per axis: sqrt(mean square / 3)
};
void visit(FieldVisitor& f, IsotropicParameters& c) {
  f.number("isotropic_min_m", c.min_m, {0.0, 1e4}, "truth_plus_isotropic: shortest error");
  f.number("isotropic_max_m", c.max_m, {0.0, 1e4}, "truth_plus_isotropic: longest error");
  f.number("isotropic_sigma_m", c.sigma_m, {1e-6, 1e4}, "truth_plus_isotropic: 1-sigma per axis that the fix claims");
}

/// The low-fidelity receiver of Durst & Goodin (2012, section 4): "the true position plus a random error of about 30 to
/// 50 centimeters", taken as a differential fix. Each epoch draws a direction uniform on the sphere and a length
/// uniform in [min, max], independent of every other epoch. It knows no satellites, so there is no DOP and no outage.
class IsotropicSensor final : public GnssSensor {
 public:
  IsotropicSensor(const IsotropicParameters& config, std::uint64_t seed, const LocalFrame& frame)
      : config_(config),
        frame_(frame),
        direction_(seed, "gnss.isotropic.direction"),
        length_(seed, "gnss.isotropic.length") {}

  GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                     const scene::SceneAt&) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    CANYON_CHECK(p_A_W.allFinite() && v_A_W.allFinite(), "antenna at ", p_A_W.transpose(), ", velocity ",
                 v_A_W.transpose());
    const auto sample = static_cast<std::uint64_t>(index);
    GnssOutput out;
    out.epoch.t = t;
    out.truth.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.fix.t = t;
    out.fix.status = FixStatus::kDifferential;
    const double length_m = length_.uniform(config_.min_m, config_.max_m, 0, sample);
    out.fix.p_A_E = out.truth.p_A_E + length_m * direction_.direction(0, sample);
    out.fix.covariance_E = config_.sigma_m * config_.sigma_m * Eigen::Matrix3d::Identity();
    ++counters_.epochs;
    return out;
  }

  GnssCounters counters() const override { return counters_; }

 private:
  IsotropicParameters config_;
  LocalFrame frame_;
  RandomStream direction_, length_;
  GnssCounters counters_;
};

}  // namespace

void isotropic_parameters(ModelParameters& section) {
  section.add<IsotropicParameters>();
}

Result<std::unique_ptr<GnssSensor>> make_isotropic_sensor(const ModelParameters& own, const SensorSetup& at) {
  const auto& p = own.get<IsotropicParameters>();
  if (p.max_m < p.min_m)
    return Error{"", 0, "gnss.isotropic_max_m", "is " + join_values(p.max_m),
                 "at least gnss.isotropic_min_m = " + join_values(p.min_m)};
  return std::unique_ptr<GnssSensor>(std::make_unique<IsotropicSensor>(p, at.noise_seed, at.scene.frame()));
}

}  // namespace canyon::gnss
