#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {
namespace {

struct BarometerParameters {
  double barometer_sigma_m = 0.5;
};
void visit(FieldVisitor& f, BarometerParameters& p) {
  f.number("barometer_sigma_m", p.barometer_sigma_m, {1e-3, 1e4}, "1-sigma of one reading, beside what lasts");
}

/// Height of the IMU, in whose box it sits: what the standard atmosphere has the pressure at, but for the state
/// barometer_bias. Nothing where the pressure is not one of the troposphere.
class Barometer final : public Copied<MeasurementModel, Barometer> {
 public:
  Barometer(const BarometerParameters& p, const ErrorState& state)
      : sigma_m_(p.barometer_sigma_m), bias_(state.offset("barometer_bias")) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const auto* sample = std::get_if<BarometerSample>(&message);
    if (sample == nullptr || !(sample->pressure_pa > kLeast_pa && sample->pressure_pa < kMost_pa)) return {};
    const Geodetic at = geodetic_from_ecef(filter.state.nav.p_EU_E);
    Measurement m(1, filter.state, ErrorIndex::kPosition);
    m.residual[0] = standard_height_m(sample->pressure_pa) - at.h_m;
    m.H.middleCols<3>(ErrorIndex::kPosition) = rotation_E_from_enu(at).col(2).transpose();
    if (bias_ >= 0) {
      m.residual[0] -= filter.state.values(bias_, 1)[0];
      m.H(0, bias_) = 1.0;
    }
    m.R(0, 0) = sigma_m_ * sigma_m_;
    return m;
  }

 private:
  static constexpr double kLeast_pa = 22700.0, kMost_pa = 127700.0;  // at 11 km and -2 km, to which the standard holds

  double sigma_m_;
  int bias_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_barometer(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Barometer>(own.get<BarometerParameters>(), at.state);
}

void barometer_parameters(ModelParameters& section) {
  section.add<BarometerParameters>();
}

}  // namespace canyon::fusion
