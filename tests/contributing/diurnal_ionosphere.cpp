// A model that nobody planned, as somebody would add it: this file, and one row.
#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {
namespace {

struct DiurnalParameters {
  double night_tecu = 5.0;
  double day_tecu = 25.0;
  double peak_hour = 14.0;
};
void visit(FieldVisitor& f, DiurnalParameters& c) {
  f.number("night_tecu", c.night_tecu, {0.0, 500.0}, "ionosphere diurnal: vertical electron content at night");
  f.number("day_tecu", c.day_tecu, {0.0, 500.0}, "ionosphere diurnal: the same at its peak");
  f.number("peak_hour", c.peak_hour, {0.0, 24.0}, "ionosphere diurnal: local solar time of the peak");
}

/// Half a cosine over the day, constant at night, in a thin shell.
class Diurnal final : public IonosphereModel {
 public:
  explicit Diurnal(const DiurnalParameters& p) : p_(p) {}
  double delay_m(const SkyView& v) const override {
    const double hours = std::fmod(v.t.sow_s() / 3600.0, 24.0) + v.receiver.lon_rad * 12.0 / kPi;
    const double sun = std::max(0.0, std::cos((hours - p_.peak_hour) * kPi / 12.0));
    const double vtec_tecu = p_.night_tecu + (p_.day_tecu - p_.night_tecu) * sun;
    return vertical_ionosphere_m(vtec_tecu) * single_layer_obliquity(v.elevation_rad);
  }

 private:
  DiurnalParameters p_;
};

}  // namespace

void diurnal_parameters(ModelParameters& section) {
  section.add<DiurnalParameters>();
}

Result<std::unique_ptr<IonosphereModel>> make_diurnal(const ModelParameters& own, const IonosphereSetup&) {
  const auto& p = own.get<DiurnalParameters>();
  if (p.day_tecu < p.night_tecu)
    return Error{"", 0, "gnss.day_tecu", "is below gnss.night_tecu", "a day that is brighter than the night"};
  return std::unique_ptr<IonosphereModel>(std::make_unique<Diurnal>(p));
}

}  // namespace canyon::gnss
