#include <cmath>

#include "canyon/core/check.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"

namespace canyon::gnss {
namespace {

struct IonexParameters {
  std::string ionex_file;
};
void visit(FieldVisitor& f, IonexParameters& c) {
  f.file("ionex_file", c.ionex_file, "", "ionosphere ionex: maps of the electron content, IONEX");
}

/// Global ionosphere maps. Where they have no value the constant `vtec_tecu` in a thin shell stands in.
class IonexIonosphere final : public IonosphereModel {
 public:
  IonexIonosphere(std::shared_ptr<const IonexMaps> maps, double vtec_tecu)
      : maps_(std::move(maps)), fallback_(make_single_layer(vtec_tecu)) {
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

std::unique_ptr<IonosphereModel> make_mapped_ionosphere(std::shared_ptr<const IonexMaps> maps, double vtec_tecu) {
  return std::make_unique<IonexIonosphere>(std::move(maps), vtec_tecu);
}

void ionex_parameters(ModelParameters& section) {
  section.add<ElectronContent>();
  section.add<IonexParameters>();
}

Result<std::unique_ptr<IonosphereModel>> make_ionex(const ModelParameters& own, const IonosphereSetup& at) {
  const std::string& file = own.get<IonexParameters>().ionex_file;
  if (file.empty()) return Error{"", 0, "gnss.ionosphere", "is \"ionex\", but there are no maps", "gnss.ionex_file"};
  CANYON_TRY(IonexMaps maps, read_ionex_file(file));
  if (at.start < maps.maps.front().t || at.end > maps.maps.back().t)
    return Error{file, 0, "gnss.ionex_file",
                 "covers " + maps.maps.front().t.iso(0) + " to " + maps.maps.back().t.iso(0) + " GPS time, not " +
                     at.start.iso(0) + " to " + at.end.iso(0),
                 "maps of that time, or a mission within theirs (time.start, time.limit_s)"};
  if (at.warnings != nullptr) at.warnings->insert(at.warnings->end(), maps.warnings.begin(), maps.warnings.end());
  return make_mapped_ionosphere(std::make_shared<const IonexMaps>(std::move(maps)),
                                own.get<ElectronContent>().vtec_tecu);
}

}  // namespace canyon::gnss
