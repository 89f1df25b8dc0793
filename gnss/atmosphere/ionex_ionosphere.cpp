#include <cmath>

#include "canyon/core/check.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"

namespace canyon::gnss {
namespace {

/// Global ionosphere maps. Where they have no value the constant `vtec_tecu` in a thin shell stands in.
class IonexIonosphere final : public IonosphereModel {
 public:
  explicit IonexIonosphere(const IonosphereParameters& p) : maps_(p.maps), fallback_(make_single_layer(p)) {
    CANYON_CHECK(maps_ != nullptr, "no maps");
  }

  double delay_m(const SkyView& v) const override {
    const double mapped_m = ionosphere_map_delay_m(*maps_, v);
    return std::isfinite(mapped_m) ? mapped_m : fallback_->delay_m(v);
  }

 private:
  std::shared_ptr<const IonexMaps> maps_;
  std::unique_ptr<IonosphereModel> fallback_;
};

}  // namespace

std::unique_ptr<IonosphereModel> make_ionex(const IonosphereParameters& p) {
  return std::make_unique<IonexIonosphere>(p);
}

}  // namespace canyon::gnss
