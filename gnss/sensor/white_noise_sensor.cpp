#include "canyon/core/check.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/random/random.h"
#include "canyon/gnss/sensor/sensor_models.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

struct WhiteNoiseParameters {
  double sigma_m = 1.0;     ///< per horizontal axis
  double sigma_up_m = 2.0;  ///< vertical
};
void visit(FieldVisitor& f, WhiteNoiseParameters& c) {
  f.number("white_sigma_m", c.sigma_m, {0.0, 1e4}, "truth_plus_white: 1-sigma per horizontal axis");
  f.number("white_sigma_up_m", c.sigma_up_m, {0.0, 1e4}, "truth_plus_white: 1-sigma of the height");
}

/// White Gaussian noise on the true position, independent from epoch to epoch and axis to axis: the receiver of most
/// robot simulators (Player/Stage with noise added by its users; Gazebo, CARLA and Webots without correlation). It
/// knows no satellites, so there is no DOP and no outage.
class WhiteNoiseSensor final : public GnssSensor {
 public:
  WhiteNoiseSensor(const WhiteNoiseParameters& config, std::uint64_t seed, const LocalFrame& frame)
      : config_(config), frame_(frame), noise_(seed, "gnss.white") {}

  GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                     const scene::SceneAt&) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    CANYON_CHECK(p_A_W.allFinite() && v_A_W.allFinite(), "antenna at ", p_A_W.transpose(), ", velocity ",
                 v_A_W.transpose());
    const auto sample = static_cast<std::uint64_t>(index);
    const Eigen::Vector3d sigma_m(config_.sigma_m, config_.sigma_m, config_.sigma_up_m);
    GnssOutput out;
    out.epoch.t = out.truth.t = out.fix.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.truth.v_A_E = frame_.R_EW() * v_A_W;
    out.fix.status = FixStatus::kSingle;
    out.fix.p_A_E = out.truth.p_A_E + frame_.R_EW() * sigma_m.cwiseProduct(noise_.normal3(sample));
    const Eigen::Vector3d claimed_m = sigma_m.cwiseMax(kLeastClaimed_m);
    out.fix.covariance_E = frame_.R_EW() * claimed_m.cwiseAbs2().asDiagonal() * frame_.R_EW().transpose();
    ++counters_.epochs;
    return out;
  }

  GnssCounters counters() const override { return counters_; }

 private:
  WhiteNoiseParameters config_;
  LocalFrame frame_;
  RandomStream noise_;
  GnssCounters counters_;
};

}  // namespace

void white_noise_parameters(ModelParameters& section) {
  section.add<WhiteNoiseParameters>();
}

Result<std::unique_ptr<GnssSensor>> make_white_noise_sensor(const ModelParameters& own, const SensorSetup& at) {
  return std::unique_ptr<GnssSensor>(
      std::make_unique<WhiteNoiseSensor>(own.get<WhiteNoiseParameters>(), at.noise_seed, at.scene.frame()));
}

}  // namespace canyon::gnss
