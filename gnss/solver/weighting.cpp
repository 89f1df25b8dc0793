#include "canyon/gnss/solver/weighting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

constexpr double kClearCn0Dbhz = 45.0;

double sin_elevation(const RangeQuality& q) {
  return std::sin(std::max(q.elevation_rad, 5.0 * kDegree));
}

/// Noise power relative to that at 45 dB-Hz. Unknown: a patch antenna loses some 7 dB from the zenith to the horizon.
double relative_noise(const RangeQuality& q) {
  const double cn0_dbhz = std::isnan(q.cn0_dbhz) ? kClearCn0Dbhz - 7.0 * (1.0 - sin_elevation(q)) : q.cn0_dbhz;
  return std::pow(10.0, 0.1 * (kClearCn0Dbhz - cn0_dbhz));
}

class Weighting : public RangeWeighting {
 public:
  explicit Weighting(const RangeWeightingParameters& p) : zenith_m_(p.sigma_m) {}

 protected:
  double zenith_m_;
};

class Uniform final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override { return q.code_factor * zenith_m_; }
};

class Elevation final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override { return q.code_factor * zenith_m_ / sin_elevation(q); }
};

/// SIGMA-epsilon of Hartinger & Brunner (1999): variance proportional to 10^(-C/N0 / 10).
class Cn0 final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override {
    return q.code_factor * zenith_m_ * std::sqrt(relative_noise(q));
  }
};

/// Multipath and atmosphere grow towards the horizon, tracking noise with falling C/N0; half the zenith's variance
/// each.
class ElevationCn0 final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override {
    const double s = sin_elevation(q);
    return q.code_factor * zenith_m_ * std::sqrt(0.5 / (s * s) + 0.5 * relative_noise(q));
  }
};

/// A budget of independent errors: sigma_m for the tracking of the code as in elevation_cn0; orbit and clock 0.8 m,
/// what broadcast ephemerides are measured to have, whatever URA they announce, GLONASS 2 m (its clocks; Montenbruck et
/// al. 2018, "Multi-GNSS signal-in-space range error assessment"); a fifth of the modelled ionosphere, what differs
/// between directions (the part that they share is PositionSolver's shared error); the troposphere's zenith 0.05 m,
/// mapped. With differential corrections the tracking alone.
class Budget final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override {
    const double s = sin_elevation(q);
    const double code_m = q.code_factor * zenith_m_;
    const double tracking2 = code_m * code_m * (0.5 / (s * s) + 0.5 * relative_noise(q));
    if (q.differential) return std::sqrt(tracking2);
    const double orbit_m = q.system == GnssSystem::kGlonass ? 2.0 : 0.8;
    const double ionosphere_m = 0.2 * q.ionosphere_m, troposphere_m = 0.05 / (s + 0.01);
    return std::sqrt(tracking2 + orbit_m * orbit_m + ionosphere_m * ionosphere_m + troposphere_m * troposphere_m);
  }
};

/// RTKLIB 2.4.3's single point positioning with its default options: code noise 0.3 m sqrt(1 + 1 / sin e), GLONASS 1.5
/// times that; code biases 0.3 m; half the modelled ionosphere; troposphere 0.3 m / (sin e + 0.1); the upper limit of
/// the announced URA's class, Galileo's SISA as it is, GLONASS 5 m. Its own numbers: `sigma_m` does not matter.
class Rtklib final : public Weighting {
 public:
  using Weighting::Weighting;
  double sigma_m(const RangeQuality& q) const override {
    const double s = sin_elevation(q);
    const double factor = q.system == GnssSystem::kGlonass ? 1.5 : q.system == GnssSystem::kSbas ? 3.0 : 1.0;
    const double code2 = q.code_factor * q.code_factor * factor * factor * 0.09 * (1.0 + 1.0 / s);
    const double troposphere_m = 0.3 / (s + 0.1);
    const double ionosphere_m = 0.5 * q.ionosphere_m, satellite_m = accuracy_m(q);
    return std::sqrt(code2 + 0.09 + ionosphere_m * ionosphere_m + troposphere_m * troposphere_m +
                     satellite_m * satellite_m);
  }

 private:
  static double accuracy_m(const RangeQuality& q) {
    // IS-GPS-200 20.3.3.3.1.3.
    constexpr std::array<double, 15> kUpperM{2.4,  3.4,   4.85,  6.85,  9.65,   13.65,  24.0,  48.0,
                                             96.0, 192.0, 384.0, 768.0, 1536.0, 3072.0, 6144.0};
    if (q.system == GnssSystem::kGlonass) return 5.0;
    if (q.system == GnssSystem::kGalileo && std::isfinite(q.accuracy_m)) return q.accuracy_m;
    const auto at = std::lower_bound(kUpperM.begin(), kUpperM.end(), std::isnan(q.accuracy_m) ? 0.0 : q.accuracy_m);
    return at == kUpperM.end() ? kUpperM.back() : *at;
  }
};

template <class Model>
std::unique_ptr<RangeWeighting> make(const ModelParameters&, const RangeWeightingParameters& p) {
  return std::make_unique<Model>(p);
}

constexpr ModelRow<MakeRangeWeighting> kWeightings[] = {
    {"uniform", make<Uniform>, "all ranges alike"},
    {"elevation", make<Elevation>, "sigma / sin(elevation)"},
    {"cn0", make<Cn0>, "variance ~ 10^(-C/N0 / 10), SIGMA-epsilon"},
    {"elevation_cn0", make<ElevationCn0>, "half of the variance ~ 1 / sin^2(elevation), half ~ 10^(-C/N0 / 10)"},
    {"budget", make<Budget>, "tracking, orbit and clock, ionosphere and troposphere, each with its own size"},
    {"rtklib", make<Rtklib>, "RTKLIB 2.4.3, single point, default options"},
};

}  // namespace

ModelTable<MakeRangeWeighting> range_weightings() {
  return kWeightings;
}

}  // namespace canyon::gnss
