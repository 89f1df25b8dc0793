// What the paper prints and what it must have meant, side by side (docs/paper.md), at the ends of their ranges.
#include <cmath>
#include <limits>

#include "canyon/core/model_choice.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
const GpsTime kT = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

std::shared_ptr<IonosphereModel> ionosphere(const char* name, double tecu) {
  ModelChoice<ionosphere_models> choice(name);
  choice.own.get<ElectronContent>().vtec_tecu = tecu;
  return *choice.make("gnss.ionosphere", IonosphereSetup{{}, kT, kT});
}

/// The printed form has no zenith delay: whatever the electrons are it says the same. The corrected one is that times
/// 40.3 N / f^2, to 8 eps at each elevation.
StressFigure unit_of_the_ionosphere(double tecu) {
  const auto printed = ionosphere("paper_printed", tecu), corrected = ionosphere("paper", tecu);
  const double zenith_m = 40.3 * tecu * 1e16 / (1575.42e6 * 1575.42e6);
  StressFigure out{0.0, 8.0 * kEpsilon * 6.0 * std::max(zenith_m, 1.0)};
  for (double e = 0.0; e <= 0.5 * kPi; e += 0.01) {
    const SkyView view{kT, {0.56, -1.5, 0.0}, e, 1.0};
    const double s = std::sin(e), mapping = 2.037 / (std::sqrt(s * s + 0.076) + s);
    take_worst(out, std::abs(printed->delay_m(view) - mapping));
    take_worst(out, std::abs(corrected->delay_m(view) - zenith_m * mapping));
  }
  return out;
}

/// At the reference radius over the equator: 10 m and its small terms as printed, 1.14 m of table 1 as corrected:
/// sqrt(10^2 + 0.2998^2 + 0.918), sqrt(1 + 0.2998^2 + 0.0918). From the ground to 1e8 m finite, and falling.
StressFigure ephemeris_term(bool corrected) {
  const std::shared_ptr<EphemerisError> model =
      corrected ? make_paper_corrected_ephemeris() : make_paper_printed_ephemeris();
  const auto at = [&](double radius_m, double sin_lat) {
    SatelliteState s;
    s.p_E = radius_m * Eigen::Vector3d(std::sqrt(1.0 - sin_lat * sin_lat), 0.0, sin_lat);
    return model->range_m({GnssSystem::kGps, 1}, s, Eigen::Vector3d::Zero(), kT);
  };
  const double ns_m2 = 0.299792458 * 0.299792458;
  const double exact = corrected ? std::sqrt(1.0 + ns_m2 + 0.0918) : std::sqrt(100.0 + ns_m2 + 0.918);
  StressFigure out{std::abs(at(26550e3, 0.0) - exact), 16.0 * kEpsilon * exact};
  const double poles = at(26550e3, 1.0), other = at(26550e3, -1.0), square = corrected ? 1.0 : 100.0;
  take_worst(out, std::abs(poles * poles - other * other - square) / (2.0 * exact));
  for (double r = 6.4e6; r < 1e8; r *= 1.1)
    if (!(std::isfinite(at(r, 0.5)) && at(r, 0.5) > at(1.1 * r, 0.5))) out.figure = 1.0;
  return out;
}

/// The printed dry term 2.2779 P / (1 - 0.00266 cos 2 lat - 0.0028 h) mm over the corrected one, 0.00028 in its place:
/// at 20 km 5.4 % too much, its pole at 356 km out of reach of the heights that are covered.
StressFigure dry_height(double height_m) {
  StressFigure out{0.0, 16.0 * kEpsilon};
  for (const double lat : {-0.5 * kPi, 0.0, 0.25 * kPi, 0.5 * kPi}) {
    const double base = 1.0 - 0.00266 * std::cos(2.0 * lat), h_km = 1e-3 * height_m;
    const double ratio =
        paper_dry_delay_m(1013.25, lat, height_m, 0.0028) / paper_dry_delay_m(1013.25, lat, height_m, 0.00028);
    take_worst(out, std::abs(ratio - (base - 0.00028 * h_km) / (base - 0.0028 * h_km)));
    if (!(paper_dry_delay_m(1013.25, lat, height_m, 0.0028) > 0.0)) out.figure = 1.0;
  }
  return out;
}

/// As printed the delay at the zenith is 1 m of "wet" and the dry term; as corrected the wet one is the zenith's.
StressFigure wet_unit() {
  const MeasuredWeather dry_air{{1000.0, 15.0, 0.0}, 0.0};
  const SkyView zenith{kT, {0.56, -1.5, 0.0}, 0.5 * kPi, 0.0};
  const double printed = make_paper_printed_troposphere(dry_air)->delay_m(zenith);
  const double corrected = make_paper_corrected_troposphere(dry_air)->delay_m(zenith);
  const double dry_printed = 2.2779 / (1.0 - 0.00266 * std::cos(1.12));
  // Without vapour nothing wet is left of the corrected one; the printed one has its metre all the same.
  StressFigure out{std::abs(printed - dry_printed - 1.0), 64.0 * kEpsilon};
  take_worst(out, std::abs(corrected - dry_printed));
  return out;
}

}  // namespace

std::vector<StressCase> paper_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "the paper's ionosphere as printed and as corrected",
           "a mapping taken as metres: the delay does not know of the electrons",
           "printed = Lear's mapping whatever the electrons; corrected = 40.3 N / f^2 times it; 8 eps", "m"});
  rows.add("paper/ionosphere_of_0_tecu", [] { return unit_of_the_ionosphere(0.0); })
      .add("paper/ionosphere_of_12_tecu", [] { return unit_of_the_ionosphere(12.0); })
      .add("paper/ionosphere_of_500_tecu", [] { return unit_of_the_ionosphere(500.0); });
  rows.of({StressGroup::kStiff, "the paper's ephemeris term as printed and as corrected",
           "a power of ten of a ratio of radii: ten times too large for the exponent, an overflow near the ground",
           "10.05 m printed, 1.087 m corrected at the reference radius over the equator; finite and falling outwards",
           "m"});
  rows.add("paper/ephemeris_as_printed", [] { return ephemeris_term(false); }).add("paper/ephemeris_as_corrected", [] {
    return ephemeris_term(true);
  });
  rows.of({StressGroup::kStiff, "the paper's dry troposphere with height",
           "0.0028 for 0.00028 per km: a pole at 356 km",
           "ratio of the denominators to 16 eps, positive from -400 m to 20 km", ""});
  rows.add("paper/dry_term_at_minus_400_m", [] { return dry_height(-400.0); }).add("paper/dry_term_at_20_km", [] {
    return dry_height(20e3);
  });
  rows.of({StressGroup::kStiff, "the paper's wet troposphere without vapour", "a bare mapping taken as metres",
           "printed: 1 m at the zenith of dry air; corrected: none; 64 eps", "m"});
  rows.add("paper/wet_term_of_dry_air", wet_unit);
  return rows.take();
}

}  // namespace canyon::gnss
