#include "canyon/gnss/errors/ephemeris_error.h"

namespace canyon::gnss {
namespace {

class NoEphemerisError final : public EphemerisError {
 public:
  double range_m(SatelliteId, const SatelliteState&, const Eigen::Vector3d&, GpsTime) const override { return 0.0; }
};

std::unique_ptr<EphemerisError> make_none(const EphemerisErrorParameters&) {
  return std::make_unique<NoEphemerisError>();
}

constexpr ModelRow<MakeEphemerisError> kModels[] = {
    {"none", make_none, "the broadcast is exact"},
    {"gauss_markov", make_gauss_markov_ephemeris,
     "per satellite, correlated over ephemeris_tau_s, ephemeris_sigma_m RMS"},
    {"orbit_clock_2010", make_orbit_clock_2010,
     "per satellite: radial, along, cross and clock as measured on 1 July 2010, SISRE 1.11 m"},
    {"orbit_clock_2021", make_orbit_clock_2021, "the same at the level of 2021, SISRE 0.89 m"},
    {"broadcast_minus_sp3", make_measured_ephemeris,
     "real: the navigation files against the precise orbits and clocks of sp3_files"},
    {"paper_printed", make_paper_printed_ephemeris, "Durst & Goodin (2012) as printed: 8 to 12 m"},
    {"paper_corrected", make_paper_corrected_ephemeris, "the form their table 1 suggests: about 1.1 m"},
};

}  // namespace

std::span<const ModelRow<MakeEphemerisError>> ephemeris_error_models() {
  return kModels;
}

}  // namespace canyon::gnss
