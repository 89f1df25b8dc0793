#include "canyon/gnss/atmosphere/ionosphere.h"

#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

class NoIonosphere final : public IonosphereModel {
 public:
  double delay_m(const SkyView&) const override { return 0.0; }
};

std::unique_ptr<IonosphereModel> make_none(const IonosphereParameters&) {
  return std::make_unique<NoIonosphere>();
}

constexpr ModelRow<MakeIonosphere> kModels[] = {
    {"none", make_none, "no delay"},
    {"single_layer", make_single_layer, "thin shell at 350 km times the zenith delay of vtec_tecu"},
    {"klobuchar", make_klobuchar, "the broadcast model, with the navigation file's coefficients"},
    {"ionex", make_ionex, "global maps of the vertical electron content, of ionex_file"},
    {"paper", make_paper_ionosphere, "Lear's mapping (Durst & Goodin 2012) times the zenith delay of vtec_tecu"},
    {"paper_printed", make_paper_printed_ionosphere, "as printed: the bare mapping, taken as metres"},
};

}  // namespace

std::span<const ModelRow<MakeIonosphere>> ionosphere_models() {
  return kModels;
}

double vertical_ionosphere_m(double vtec_tecu) {
  return 40.3e16 * vtec_tecu / (kL1Hz * kL1Hz);
}

}  // namespace canyon::gnss
