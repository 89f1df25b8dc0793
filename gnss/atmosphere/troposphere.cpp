#include "canyon/gnss/atmosphere/troposphere.h"

namespace canyon::gnss {
namespace {

class NoTroposphere final : public TroposphereModel {
 public:
  double delay_m(const SkyView&) const override { return 0.0; }
};

/// What a receiver without weather sensors assumes, taken for the truth.
class StandardTroposphere final : public TroposphereModel {
 public:
  double delay_m(const SkyView& view) const override { return standard_troposphere_m(view); }
};

std::unique_ptr<TroposphereModel> make_standard(const MeasuredWeather&) {
  return std::make_unique<StandardTroposphere>();
}

std::unique_ptr<TroposphereModel> make_none(const MeasuredWeather&) {
  return std::make_unique<NoTroposphere>();
}

constexpr ModelRow<MakeTroposphere> kModels[] = {
    {"none", make_none, "no delay"},
    {"standard", make_standard, "Saastamoinen and Niell for the ICAO standard atmosphere at the receiver's height"},
    {"saastamoinen_niell", make_saastamoinen_niell,
     "Saastamoinen zenith delays of the weather, carried to the receiver's height; Niell (1996) mappings"},
    {"paper_printed", make_paper_printed_troposphere,
     "as printed: bare wet mapping as metres, dry delay without mapping"},
    {"paper_corrected", make_paper_corrected_troposphere,
     "the paper's terms with zenith delay, mapping and units put right"},
};

}  // namespace

std::span<const ModelRow<MakeTroposphere>> troposphere_models() {
  return kModels;
}

}  // namespace canyon::gnss
