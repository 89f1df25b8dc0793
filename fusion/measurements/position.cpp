#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "canyon/fusion/measurements/body_motion.h"
#include "canyon/fusion/measurements/fix_age.h"
#include "canyon/fusion/states/fix_error.h"

namespace canyon::fusion {
namespace {

struct PositionParameters {
  std::string fix_covariance = "as_reported";
  double fix_sigma_scale = 2.0;
  double fix_sigma_m = 3.0;
  double fix_sigma_floor_m = 0.0;
};
void visit(FieldVisitor& f, PositionParameters& p) {
  f.choice("fix_covariance", p.fix_covariance, {"as_reported", "inflated", "from_dop", "constant"},
           "what a fix's position counts for: what it says; fix_sigma_scale times its 1-sigma; fix_sigma_m times its "
           "dilution of precision; fix_sigma_m on each axis");
  f.number("fix_sigma_scale", p.fix_sigma_scale, {0.01, 1000}, "of \"inflated\"");
  f.number("fix_sigma_m", p.fix_sigma_m, {1e-4, 1e4}, "of \"from_dop\", per pseudorange, and of \"constant\"");
  f.number("fix_sigma_floor_m", p.fix_sigma_floor_m, {0, 1e3}, "lower bound on a fix's 1-sigma per axis");
}

enum class FixCovariance { kAsReported, kInflated, kFromDop, kConstant };

FixCovariance kind_of(const std::string& name) {
  if (name == "inflated") return FixCovariance::kInflated;
  if (name == "from_dop") return FixCovariance::kFromDop;
  if (name == "constant") return FixCovariance::kConstant;
  return FixCovariance::kAsReported;
}

/// The antenna's place, carried to the time of the fix with the estimated velocity, and an error of the fixes that
/// lasts where the states have one.
class Position final : public Copied<MeasurementModel, Position> {
 public:
  Position(const PositionParameters& p, const FixErrorParameters& lasting, const ErrorState& state)
      : p_(p),
        kind_(kind_of(p.fix_covariance)),
        lasting_(lasting),
        age_(state),
        fix_error_(state.offset("fix_error")) {}

  void start() override {
    last_ = {};
    renewed_.clear();
  }

  int parts(const FilterView& filter, const AidingMessage& message) override {
    renewed_.clear();
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix != nullptr && fix->status != FixStatus::kNone && fix_error_ >= 0) renew(filter, *fix);
    return 1;
  }

  std::span<const Renewal> renewed() const override { return renewed_; }

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix == nullptr || fix->status == FixStatus::kNone) return {};
    const PointPlace antenna = antenna_place(filter);
    const PointVelocity moving = antenna_velocity(filter);
    const double age_s = age_.of(filter, fix->t);
    Measurement m(3, filter.state, ErrorIndex::kPosition);
    m.residual = fix->p_A_E - (antenna.p_E + age_s * moving.v_E);
    m.motion.emplace().speed_m_s = moving.v_E.norm();
    if (fix->v_A_E.allFinite() && fix->velocity_covariance_E.allFinite()) {
      m.motion->residual_m_s = fix->v_A_E - moving.v_E;
      m.motion->measured = true;
    }
    m.H = age_s * moving.H;
    m.H += antenna.H;
    age_.set_column(m.H, moving.v_E);
    m.R = covariance(*fix);
    m.R.diagonal() = m.R.diagonal().cwiseMax(p_.fix_sigma_floor_m * p_.fix_sigma_floor_m);  // still positive definite
    if (fix_error_ >= 0) {
      const Eigen::Matrix3d share = lasting_.share(fix->covariance_E);
      m.residual -= share * filter.state.values(fix_error_, 3);
      m.H.middleCols<3>(fix_error_) = share;
    }
    return m;
  }

 private:
  /// The antenna's way since the last fix has changed the echoes.
  void renew(const FilterView& filter, const GnssFix& fix) {
    const double way_m = last_ ? std::abs(fix.t - *last_) * antenna_velocity(filter).v_E.norm() : 0.0;
    last_ = fix.t;
    const double kept = std::exp(-way_m / lasting_.fix_error_way_m);
    if (kept > kStill) return;
    for (int i = 0; i < 3; ++i) renewed_.push_back({fix_error_ + i, kept});
  }

  Eigen::Matrix3d covariance(const GnssFix& fix) const {
    const double variance = p_.fix_sigma_m * p_.fix_sigma_m;
    switch (kind_) {
      case FixCovariance::kConstant:
        return variance * Eigen::Matrix3d::Identity();
      case FixCovariance::kFromDop:
        if (std::isfinite(fix.dop.hdop) && std::isfinite(fix.dop.vdop)) {
          const Eigen::Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E));
          const double across = 0.5 * fix.dop.hdop * fix.dop.hdop;
          return variance * R_EN * Eigen::Vector3d(across, across, fix.dop.vdop * fix.dop.vdop).asDiagonal() *
                 R_EN.transpose();
        }
        break;
      case FixCovariance::kInflated:
        return 0.5 * p_.fix_sigma_scale * p_.fix_sigma_scale * (fix.covariance_E + fix.covariance_E.transpose());
      case FixCovariance::kAsReported:
        break;
    }
    return 0.5 * (fix.covariance_E + fix.covariance_E.transpose());
  }

  static constexpr double kStill = 1.0 - 1e-6;  ///< what is kept of an error that a way has not changed

  PositionParameters p_;
  FixCovariance kind_;
  FixErrorParameters lasting_;
  FixAge age_;
  int fix_error_;
  std::optional<GpsTime> last_;
  std::vector<Renewal> renewed_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_position(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Position>(own.get<PositionParameters>(), own.get<FixErrorParameters>(), at.state);
}

void position_parameters(ModelParameters& section) {
  section.add<PositionParameters>();
}

}  // namespace canyon::fusion
