#include <cmath>

#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {
namespace {

/// Durst & Goodin (2012) print dR = 2.037 / (sqrt(sin^2 e + 0.076) + sin e) and call it a range error in metres. It is
/// a mapping function (1 at the zenith, 5.4 at 5 deg) that lacks the zenith delay: as printed, the ionosphere always
/// delays by 1 m overhead. `paper` multiplies by the zenith delay of the VTEC, 1.95 m for 12 TECU.
class LearIonosphere final : public IonosphereModel {
 public:
  explicit LearIonosphere(double zenith_m) : zenith_m_(zenith_m) {}
  double delay_m(const SkyView& view) const override { return zenith_m_ * lear_mapping(view.elevation_rad); }

 private:
  double zenith_m_;
};

}  // namespace

double lear_mapping(double elevation_rad) {
  const double s = std::sin(elevation_rad);
  return 2.037 / (std::sqrt(s * s + 0.076) + s);
}

Result<std::unique_ptr<IonosphereModel>> make_paper_ionosphere(const ModelParameters& own, const IonosphereSetup&) {
  const double zenith_m = vertical_ionosphere_m(own.get<ElectronContent>().vtec_tecu);
  return std::unique_ptr<IonosphereModel>(std::make_unique<LearIonosphere>(zenith_m));
}

Result<std::unique_ptr<IonosphereModel>> make_paper_printed_ionosphere(const ModelParameters&, const IonosphereSetup&) {
  return std::unique_ptr<IonosphereModel>(std::make_unique<LearIonosphere>(1.0));
}

}  // namespace canyon::gnss
