#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/errors/gauss_markov.h"

namespace canyon::gnss {
namespace {

struct GaussMarkovParameters {
  double sigma_m = 1.0;
  double tau_s = 3600.0;
};
void visit(FieldVisitor& f, GaussMarkovParameters& c) {
  f.number("ephemeris_sigma_m", c.sigma_m, {0.0, 1000.0}, "ephemeris_error gauss_markov: 1-sigma of the range error");
  f.number("ephemeris_tau_s", c.tau_s, {60.0, 1e6}, "ephemeris_error gauss_markov: correlation time");
}

/// Signal-in-space range error of each satellite as its own Gauss-Markov process. Measured over the constellation it
/// was 1.11 m RMS on 1 July 2010 (broadcast minus IGS final orbits); clocks dominate, and decorrelate over an hour or
/// so.
class GaussMarkovEphemeris final : public EphemerisError {
 public:
  GaussMarkovEphemeris(std::uint64_t seed, double sigma_m, double tau_s)
      : process_(seed, "gnss.ephemeris", tau_s), sigma_m_(sigma_m) {}
  double range_m(SatelliteId sv, const SatelliteState&, const Eigen::Vector3d&, GpsTime t) const override {
    return sigma_m_ * process_.at(sv.entity(), t);
  }

 private:
  GaussMarkov process_;
  double sigma_m_;
};

}  // namespace

std::unique_ptr<EphemerisError> make_gauss_markov_ephemeris(std::uint64_t seed, double sigma_m, double tau_s) {
  return std::make_unique<GaussMarkovEphemeris>(seed, sigma_m, tau_s);
}

void gauss_markov_parameters(ModelParameters& section) {
  section.add<GaussMarkovParameters>();
}

double largest_gauss_markov_m(const ModelParameters& own) {
  return GaussMarkov::kMostSigmas * own.get<GaussMarkovParameters>().sigma_m;
}

Result<std::unique_ptr<EphemerisError>> make_gauss_markov(const ModelParameters& own, const EphemerisErrorSetup& at) {
  const auto& p = own.get<GaussMarkovParameters>();
  return make_gauss_markov_ephemeris(at.seed, p.sigma_m, p.tau_s);
}

}  // namespace canyon::gnss
