#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {
namespace {

struct MagnetometerParameters {
  double magnetic_declination_deg = 0.0;
  double magnetic_inclination_deg = 60.0;
  double magnetic_strength_ut = 50.0;
  double magnetometer_sigma_ut = 1.0;
};
void visit(FieldVisitor& f, MagnetometerParameters& p) {
  f.number("magnetic_declination_deg", p.magnetic_declination_deg, {-180, 180},
           "of the Earth's field there from true north, east positive, as the filter is told");
  f.number("magnetic_inclination_deg", p.magnetic_inclination_deg, {-90, 90}, "its angle below the horizon");
  f.number("magnetic_strength_ut", p.magnetic_strength_ut, {1, 1000}, "its strength");
  f.number("magnetometer_sigma_ut", p.magnetometer_sigma_ut, {1e-4, 1000},
           "1-sigma per axis of one reading, soft iron included");
}

/// The Earth's field in U, and the vehicle's own as the state hard_iron has it, microtesla.
class Magnetometer final : public Copied<MeasurementModel, Magnetometer> {
 public:
  Magnetometer(const MagnetometerParameters& p, const ErrorState& state)
      : variance_(p.magnetometer_sigma_ut * p.magnetometer_sigma_ut), hard_iron_(state.offset("hard_iron")) {
    const double east = p.magnetic_declination_deg * kDegree, down = p.magnetic_inclination_deg * kDegree;
    field_W_ut_ = p.magnetic_strength_ut *
                  Eigen::Vector3d(std::cos(down) * std::sin(east), std::cos(down) * std::cos(east), -std::sin(down));
  }

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const auto* sample = std::get_if<MagnetometerSample>(&message);
    if (sample == nullptr || !sample->field_U_t.allFinite()) return {};
    const Eigen::Vector3d field_U_ut = filter.state.nav.R_EU.conjugate() * (filter.frame.R_EW() * field_W_ut_);
    Measurement m(3, filter.state, ErrorIndex::kTheta);
    m.residual = sample->field_U_t / kMicrotesla - field_U_ut;
    m.H.leftCols<3>() = skew(field_U_ut);
    if (hard_iron_ >= 0) {
      m.residual -= filter.state.values(hard_iron_, 3);
      m.H.middleCols<3>(hard_iron_).setIdentity();
    }
    m.R.diagonal().setConstant(variance_);
    return m;
  }

 private:
  static constexpr double kMicrotesla = 1e-6;

  double variance_;
  int hard_iron_;
  Eigen::Vector3d field_W_ut_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_magnetometer(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Magnetometer>(own.get<MagnetometerParameters>(), at.state);
}

void magnetometer_parameters(ModelParameters& section) {
  section.add<MagnetometerParameters>();
}

}  // namespace canyon::fusion
