#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {
namespace {

class KlobucharIonosphere final : public IonosphereModel {
 public:
  explicit KlobucharIonosphere(const KlobucharCoefficients& c) : coefficients_(c) {}
  double delay_m(const SkyView& v) const override {
    return klobuchar_delay_m(coefficients_, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad,
                             v.elevation_rad);
  }

 private:
  KlobucharCoefficients coefficients_;
};

}  // namespace

Result<std::unique_ptr<IonosphereModel>> make_klobuchar(const ModelParameters&, const IonosphereSetup& at) {
  return std::unique_ptr<IonosphereModel>(std::make_unique<KlobucharIonosphere>(at.klobuchar));
}

}  // namespace canyon::gnss
