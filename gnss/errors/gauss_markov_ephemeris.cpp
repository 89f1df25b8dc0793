#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/errors/gauss_markov.h"

namespace canyon::gnss {
namespace {

/// Signal-in-space range error of each satellite as its own Gauss-Markov process. Measured over the constellation it
/// was 1.11 m RMS on 1 July 2010 (broadcast minus IGS final orbits); clocks dominate, and decorrelate over an hour or
/// so.
class GaussMarkovEphemeris final : public EphemerisError {
 public:
  explicit GaussMarkovEphemeris(const EphemerisErrorParameters& p)
      : process_(p.seed, "gnss.ephemeris", p.tau_s), sigma_m_(p.sigma_m) {}
  double range_m(SatelliteId sv, const SatelliteState&, const Eigen::Vector3d&, GpsTime t) const override {
    return sigma_m_ * process_.at(sv.entity(), t);
  }

 private:
  GaussMarkov process_;
  double sigma_m_;
};

}  // namespace

std::unique_ptr<EphemerisError> make_gauss_markov_ephemeris(const EphemerisErrorParameters& p) {
  return std::make_unique<GaussMarkovEphemeris>(p);
}

}  // namespace canyon::gnss
