#include <cmath>

#include "canyon/core/units.h"
#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {
namespace {

struct StandstillParameters {
  double standstill_window_s = 0.5;
  double standstill_force_m_s2 = 0.05;
  double standstill_rate_deg_s = 0.5;
  double standstill_speed_m_s = 0.5;
  double standstill_sigma_m_s = 0.02;
};
void visit(FieldVisitor& f, StandstillParameters& p) {
  f.number("standstill_window_s", p.standstill_window_s, {0.05, 60}, "over which the vehicle must have stood");
  f.number(
      "standstill_force_m_s2", p.standstill_force_m_s2, {1e-6, 10},
      "standard deviation of each axis of the force in it, above which the vehicle moves; beside the unit's noise");
  f.number("standstill_rate_deg_s", p.standstill_rate_deg_s, {1e-6, 100},
           "mean rate of turn in it, above which the vehicle moves");
  f.number("standstill_speed_m_s", p.standstill_speed_m_s, {0.01, 100},
           "estimated speed above which nothing is taken for standing");
  f.number("standstill_sigma_m_s", p.standstill_sigma_m_s, {1e-5, 10}, "1-sigma of the velocity while it stands");
}

/// Zero velocity, at the end of each window in which force and rate say that the vehicle stood. An even road at an even
/// speed looks the same to an IMU, so the estimated speed must be small as well.
class Standstill final : public Copied<MeasurementModel, Standstill> {
 public:
  Standstill(const StandstillParameters& p, const ImuNoise& noise) : p_(p), noise_(noise) {}

  void start() override { begin(); }

  std::optional<Measurement> stepped(const FilterView& filter, const Increments& in) override {
    ++samples_;
    elapsed_s_ += in.dt_s;
    const Eigen::Vector3d force = in.dv_U / in.dt_s;
    if (samples_ == 1) first_ = force;
    // By time: a message may have divided the sample.
    force_sum_ += in.dt_s * (force - first_);
    force_squares_ += in.dt_s * (force - first_).cwiseAbs2();
    rate_sum_ += in.dt_s * filter.w_EU_U;
    if (elapsed_s_ < (1.0 - 1e-9) * p_.standstill_window_s) return {};
    const bool still = stood();
    begin();
    if (!still) return {};
    const BodyVelocity body = body_velocity(filter, Eigen::Vector3d::Zero());
    if (body.v_B.norm() > p_.standstill_speed_m_s) return {};
    Measurement m(3, filter.state, ErrorIndex::kVelocity);
    m.residual = -body.v_B;
    m.H = body.H;
    m.R.diagonal().setConstant(p_.standstill_sigma_m_s * p_.standstill_sigma_m_s);
    return m;
  }

 private:
  void begin() {
    samples_ = 0;
    elapsed_s_ = 0.0;
    force_sum_.setZero();
    force_squares_.setZero();
    rate_sum_.setZero();
  }

  bool stood() const {
    if (samples_ < 4) return false;
    const double per_root_s = std::sqrt(samples_ / elapsed_s_);
    const Eigen::Vector3d variance = force_squares_ / elapsed_s_ - (force_sum_ / elapsed_s_).cwiseAbs2();
    // Twice the unit's own: of twenty samples' standard deviations one in 5e8 is larger (chi-square of 19 above 80).
    const double own_force = 2.0 * noise_.accel.white_per_sqrt_hz * per_root_s;
    const double force = std::hypot(p_.standstill_force_m_s2, own_force);
    const double own_rate = 3.0 * noise_.gyro.white_per_sqrt_hz / std::sqrt(elapsed_s_);
    const double rate = std::hypot(p_.standstill_rate_deg_s * kDegree, own_rate);
    return variance.maxCoeff() < force * force && (rate_sum_ / elapsed_s_).norm() < rate;
  }

  StandstillParameters p_;
  ImuNoise noise_;
  int samples_ = 0;
  double elapsed_s_ = 0.0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero(), force_sum_ = Eigen::Vector3d::Zero(),
                  force_squares_ = Eigen::Vector3d::Zero(), rate_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::unique_ptr<MeasurementModel> make_standstill(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Standstill>(own.get<StandstillParameters>(), at.noise);
}

void standstill_parameters(ModelParameters& section) {
  section.add<StandstillParameters>();
}

}  // namespace canyon::fusion
