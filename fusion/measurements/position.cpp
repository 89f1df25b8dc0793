#include <algorithm>

#include "canyon/fusion/antenna_position.h"
#include "canyon/fusion/measurements/body_velocity.h"

namespace canyon::fusion {
namespace {

struct PositionParameters {
  double fix_sigma_floor_m = 0.0;
};
void visit(FieldVisitor& f, PositionParameters& p) {
  f.number("fix_sigma_floor_m", p.fix_sigma_floor_m, {0, 1e3}, "lower bound on a fix's 1-sigma per axis");
}

/// The antenna's place, carried to the time of the fix with the estimated velocity, and an error of the fixes that
/// lasts where the states have one.
class Position final : public MeasurementModel {
 public:
  Position(const PositionParameters& p, const ErrorState& state)
      : floor_m2_(p.fix_sigma_floor_m * p.fix_sigma_floor_m), fix_error_(state.offset("fix_error")) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message) override {
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix == nullptr || fix->status == FixStatus::kNone) return {};
    const double age_s = fix->t - filter.state.nav.t;
    const AntennaPosition antenna =
        antenna_position(filter.state.nav, filter.w_EU_U, filter.lever_A_B - filter.lever_U_B, age_s);
    Measurement m(3, filter.state);
    m.residual = fix->p_A_E - antenna.p_A_E;
    m.R = 0.5 * (fix->covariance_E + fix->covariance_E.transpose());
    m.R.diagonal() = m.R.diagonal().cwiseMax(floor_m2_);  // which keeps it positive definite
    m.H.leftCols<9>() = antenna.H;
    // What carries it there depends on the rate of turn as well.
    if (age_s != 0.0) {
      const BodyRows carried = age_s * point_velocity(filter, filter.lever_A_B).H;
      m.H.leftCols<3>() =
          antenna_position(filter.state.nav, filter.w_EU_U, filter.lever_A_B - filter.lever_U_B, 0.0).H.leftCols<3>() +
          carried.leftCols<3>();
      m.H.rightCols(m.H.cols() - 9) = carried.rightCols(m.H.cols() - 9);
    }
    if (fix_error_ >= 0) {
      m.residual -= filter.state.values(fix_error_, 3);
      m.H.middleCols<3>(fix_error_).setIdentity();
    }
    return m;
  }

 private:
  double floor_m2_;
  int fix_error_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_position(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Position>(own.get<PositionParameters>(), at.state);
}

void position_parameters(ModelParameters& section) {
  section.add<PositionParameters>();
}

}  // namespace canyon::fusion
