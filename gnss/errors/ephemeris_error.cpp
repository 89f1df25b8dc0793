#include "canyon/gnss/errors/ephemeris_error.h"

namespace canyon::gnss {
namespace {

class NoEphemerisError final : public EphemerisError {
 public:
  double range_m(SatelliteId, const SatelliteState&, const Eigen::Vector3d&, GpsTime) const override { return 0.0; }
};

/// A row's maker of a model that needs no key.
template <auto Make>
Result<std::unique_ptr<EphemerisError>> plain(const ModelParameters&, const EphemerisErrorSetup&) {
  return Make();
}
template <auto Make>
Result<std::unique_ptr<EphemerisError>> seeded(const ModelParameters&, const EphemerisErrorSetup& at) {
  return Make(at.seed);
}

std::unique_ptr<EphemerisError> make_no_error() {
  return std::make_unique<NoEphemerisError>();
}

double nothing_m(const ModelParameters&) {
  return 0.0;
}

constexpr ModelRow<MakeEphemerisError> kModels[] = {
    {"none", {plain<make_no_error>, nothing_m}, "the broadcast is exact"},
    {"gauss_markov",
     {make_gauss_markov, largest_gauss_markov_m},
     "per satellite, correlated over ephemeris_tau_s, ephemeris_sigma_m RMS",
     gauss_markov_parameters},
    {"orbit_clock_2010",
     {seeded<make_orbit_clock_2010>, largest_orbit_clock_2010_m},
     "per satellite: radial, along, cross and clock as measured on 1 July 2010, SISRE 1.11 m"},
    {"orbit_clock_2021",
     {seeded<make_orbit_clock_2021>, largest_orbit_clock_2021_m},
     "the same at the level of 2021, SISRE 0.89 m"},
    {"broadcast_minus_sp3", make_broadcast_minus_sp3,
     "real: the navigation files against the precise orbits and clocks of sp3_files", broadcast_minus_sp3_parameters},
    {"paper_printed", plain<make_paper_printed_ephemeris>, "Durst & Goodin (2012) as printed: 8 to 12 m"},
    {"paper_corrected", plain<make_paper_corrected_ephemeris>, "the form their table 1 suggests: about 1.1 m"},
};

}  // namespace

ModelTable<MakeEphemerisError> ephemeris_error_models() {
  return kModels;
}

}  // namespace canyon::gnss
