#include "canyon/gnss/atmosphere/ionosphere.h"

#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

class NoIonosphere final : public IonosphereModel {
 public:
  double delay_m(const SkyView&) const override { return 0.0; }
  bool acts() const override { return false; }
};

Result<std::unique_ptr<IonosphereModel>> make_none(const ModelParameters&, const IonosphereSetup&) {
  return std::unique_ptr<IonosphereModel>(std::make_unique<NoIonosphere>());
}
Result<std::unique_ptr<IonosphereModel>> make_layer(const ModelParameters& own, const IonosphereSetup&) {
  return make_single_layer(own.get<ElectronContent>().vtec_tecu);
}

constexpr ModelRow<MakeIonosphere> kIonospheres[] = {
    {"none", {make_none, largest_at_lowest}, "no delay"},
    {"single_layer",
     {make_layer, largest_at_lowest},
     "thin shell at 350 km times the zenith delay of vtec_tecu",
     parameters_of<ElectronContent>},
    {"klobuchar", make_klobuchar, "the broadcast model, with the navigation file's coefficients"},
    {"ionex", make_ionex, "global maps of the vertical electron content, of ionex_file", ionex_parameters},
    {"paper",
     {make_paper_ionosphere, largest_at_lowest},
     "Lear's mapping (Durst & Goodin 2012) times the zenith delay of vtec_tecu",
     parameters_of<ElectronContent>},
    {"paper_printed",
     {make_paper_printed_ionosphere, largest_at_lowest},
     "as printed: the bare mapping, taken as metres"},
};

}  // namespace

void visit(FieldVisitor& f, ElectronContent& c) {
  f.number("vtec_tecu", c.vtec_tecu, {0.0, 500.0}, "vertical total electron content");
}

ModelTable<MakeIonosphere> ionosphere_models() {
  return kIonospheres;
}

double largest_at_lowest(const IonosphereModel& model, const SkyView& lowest) {
  return model.delay_m(lowest);
}

double vertical_ionosphere_m(double vtec_tecu) {
  return 40.3e16 * vtec_tecu / (kL1Hz * kL1Hz);
}

}  // namespace canyon::gnss
