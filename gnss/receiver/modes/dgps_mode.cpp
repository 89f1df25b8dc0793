#include <cmath>
#include <cstdio>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/receiver/modes/air_between.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// A base station at a known point, `baseline` away, measures each satellite's whole range error and broadcasts it.
/// What remains:
///
/// - ionosphere and troposphere: what the air between them makes of it (air_between.h). Both ends correct the known
///   height difference;
/// - orbit: the range error x baseline / range (the worst direction); the satellite clock's part cancels altogether;
/// - the base's own code noise and multipath, correlated over 100 s of carrier smoothing: sigma = 0.16 + 1.07 exp(-e
/// / 15.5 deg) m,
///   ground accuracy designator B (McGraw et al. 2000).
///
/// The correction's latency is ignored: without selective availability all of this changes by millimetres in seconds.
/// The base's clock is common to all satellites and goes into the receiver clock.
class Dgps final : public ReceiverMode {
 public:
  Dgps(const DgpsParameters& p, const ReceiverModeSetup& at)
      : p_(p), at_(at), air_(p, at), base_(at.seed, "gnss.dgps.base", 100.0) {}

  Correction correction(const CorrectionInput& in) const override {
    const double elevation_rad = in.true_view.elevation_rad;
    RangeDelays residual;
    if (!in.leave_out.ionosphere_difference) residual.ionosphere_m = air_.ionosphere_m(in, p_.baseline_km);
    if (!in.leave_out.troposphere_difference) residual.troposphere_m = air_.troposphere_m(in, p_.baseline_km);
    residual.ephemeris_m = in.acting.ephemeris_m * 1e3 * p_.baseline_km / in.range_m;

    Correction c;
    c.modelled.ionosphere_m = in.acting.ionosphere_m - residual.ionosphere_m;
    c.modelled.troposphere_m = in.acting.troposphere_m - residual.troposphere_m;
    c.modelled.ephemeris_m = in.acting.ephemeris_m - residual.ephemeris_m;
    const double base_sigma_m = 0.16 + 1.07 * std::exp(-elevation_rad / (15.5 * kDegree));
    c.base_m = p_.base_error_scale * base_sigma_m * base_.at(in.sv.entity(), in.t);
    return c;
  }
  int asks(const DelayOmissions& leave_out) const override {
    return (at_.ionosphere && !leave_out.ionosphere_difference) +
           (at_.troposphere && !leave_out.troposphere_difference);
  }
  FixStatus status() const override { return FixStatus::kDifferential; }
  bool corrects_atmosphere() const override { return true; }

 private:
  DgpsParameters p_;
  ReceiverModeSetup at_;
  AirBetween air_;
  GaussMarkov base_;
};

// What satellites do at most, seen from the ground: no range of GPS, Galileo, GLONASS, BeiDou or QZSS changes faster
// (speed times the sine of the nadir angle, and the radial speed of an eccentric orbit), none is shorter.
constexpr double kMostRangeRate_m_s = 1100.0;
constexpr double kShortestRange_m = 1.8e7;
// Of ranges in double precision, from measuring to correcting: some ten sums of 3e7 m.
constexpr double kRounding_m = 1e-7;
// First signals lie at 1561 MHz (B1I) and above.
constexpr double kMostFromL1 = 1.02;

std::string text(const char* format, double a, double b) {
  char out[160];
  std::snprintf(out, sizeof out, format, a, b);
  return out;
}

/// A delay that is subtracted as it acts does not cancel to the bit: it makes the receiver believe in another time of
/// transmission, delay / c earlier, and so in a satellite that stands elsewhere by its speed times that.
Need cancelled(const char* effect, double delay_m) {
  return {.effect = effect,
          .verdict = Verdict::kNotNeeded,
          .bound = delay_m * kMostRangeRate_m_s / kSpeedOfLight + kRounding_m,
          .bound_unit = "m",
          .reason = text("the base sees it too: of %.1f m what the satellite moves by meanwhile is left, at %g m/s",
                         delay_m, kMostRangeRate_m_s)};
}

Need difference(const char* effect, double vertical_sigma_m, double mapping, double baseline_km) {
  return {.effect = effect,
          .verdict = Verdict::kNotNeeded,
          .bound = GaussMarkov::kMostSigmas * vertical_sigma_m * mapping + kRounding_m,
          .bound_unit = "m",
          .reason = text("at %g km from the base it is %.2g m (1-sigma) for the lowest satellite", baseline_km,
                         vertical_sigma_m * mapping)};
}

}  // namespace

void visit(FieldVisitor& f, DgpsParameters& c) {
  f.number("baseline_km", c.baseline_km, {0.0, 500.0}, "dgps: distance of the base station");
  f.number("ionosphere_gradient_mm_per_km", c.ionosphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps, dgps_base: 1-sigma of the difference of the vertical ionospheric delay to the base");
  f.number("troposphere_gradient_mm_per_km", c.troposphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps, dgps_base: 1-sigma of the difference of the zenith wet delay to the base");
  f.number(
      "base_error_scale", c.base_error_scale, {0.0, 100.0},
      "base station's own error; dgps: 1 = ground accuracy designator B, dgps_base: of its receiver's thermal noise");
}

std::vector<Need> dgps_needs(const ModelParameters& own, const DelayQuestion& q) {
  const auto& p = own.get<DgpsParameters>();
  const double km = p.baseline_km;
  std::vector<Need> needs;
  if (q.ionosphere_m > 0.0) needs.push_back(cancelled(kIonosphere, *q.ionosphere_m));
  if (q.ionosphere_m != 0.0)
    needs.push_back(difference(kIonosphereDifference, 1e-3 * p.ionosphere_gradient_mm_per_km * km,
                               kMostFromL1 * single_layer_obliquity(q.lowest_elevation_rad), km));
  if (q.troposphere_m > 0.0) needs.push_back(cancelled(kTroposphere, *q.troposphere_m));
  if (q.troposphere_m != 0.0)
    needs.push_back(difference(kTroposphereDifference, 1e-3 * p.troposphere_gradient_mm_per_km * km,
                               niell_wet(q.lowest_elevation_rad, q.lat_rad), km));
  if (q.ephemeris_m > 0.0) {
    Need need = cancelled(kEphemeris, *q.ephemeris_m);
    const double left_m = *q.ephemeris_m * 1e3 * km / kShortestRange_m;
    need.bound += left_m;
    need.reason = text("of %.1f m at most the base, %g km away, leaves the part baseline / range", *q.ephemeris_m, km);
    needs.push_back(std::move(need));
  }
  return needs;
}

std::unique_ptr<ReceiverMode> make_dgps(const ModelParameters& own, const ReceiverModeSetup& at) {
  return std::make_unique<Dgps>(own.get<DgpsParameters>(), at);
}

}  // namespace canyon::gnss
