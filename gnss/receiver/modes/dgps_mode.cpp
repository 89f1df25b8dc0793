#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// A base station at a known point, `baseline` away, measures each satellite's whole range error and broadcasts it.
/// What remains:
///
/// - ionosphere: vertical gradient x baseline x thin-shell obliquity, per satellite (their pierce points differ),
/// correlated over
///   half an hour. On quiet days the gradient is 1 to 2 mm/km (1-sigma);
/// - troposphere: difference of the zenith wet delay x Niell's wet mapping, one for all satellites, correlated over an
/// hour. Both
///   ends correct the known height difference;
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
      : p_(p),
        at_(at),
        ionosphere_(at.seed, "gnss.dgps.ionosphere", 1800.0),
        troposphere_(at.seed, "gnss.dgps.troposphere", 3600.0),
        base_(at.seed, "gnss.dgps.base", 100.0) {}

  Correction correction(const CorrectionInput& in) const override {
    const double elevation_rad = in.true_view.elevation_rad;
    RangeDelays residual;
    if (at_.ionosphere)
      residual.ionosphere_m = 1e-3 * p_.ionosphere_gradient_mm_per_km * p_.baseline_km *
                              ionosphere_.at(in.sv.entity(), in.t) * single_layer_obliquity(elevation_rad) *
                              in.ionosphere_from_l1;
    if (at_.troposphere)
      residual.troposphere_m = 1e-3 * p_.troposphere_gradient_mm_per_km * p_.baseline_km * troposphere_.at(0, in.t) *
                               niell_wet(elevation_rad, in.true_view.receiver.lat_rad);
    residual.ephemeris_m = in.acting.ephemeris_m * 1e3 * p_.baseline_km / in.range_m;

    Correction c;
    c.modelled.ionosphere_m = in.acting.ionosphere_m - residual.ionosphere_m;
    c.modelled.troposphere_m = in.acting.troposphere_m - residual.troposphere_m;
    c.modelled.ephemeris_m = in.acting.ephemeris_m - residual.ephemeris_m;
    const double base_sigma_m = 0.16 + 1.07 * std::exp(-elevation_rad / (15.5 * kDegree));
    c.base_m = p_.base_error_scale * base_sigma_m * base_.at(in.sv.entity(), in.t);
    return c;
  }
  FixStatus status() const override { return FixStatus::kDifferential; }
  bool corrects_atmosphere() const override { return true; }

 private:
  DgpsParameters p_;
  ReceiverModeSetup at_;
  GaussMarkov ionosphere_, troposphere_, base_;
};

}  // namespace

void visit(FieldVisitor& f, DgpsParameters& c) {
  f.number("baseline_km", c.baseline_km, {0.0, 500.0}, "dgps: distance of the base station");
  f.number("ionosphere_gradient_mm_per_km", c.ionosphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps: 1-sigma of the difference of the vertical ionospheric delay to the base");
  f.number("troposphere_gradient_mm_per_km", c.troposphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps: 1-sigma of the difference of the zenith wet delay to the base");
  f.number("base_error_scale", c.base_error_scale, {0.0, 100.0},
           "dgps: base station's own error, 1 = ground accuracy designator B");
}

std::unique_ptr<ReceiverMode> make_dgps(const ModelParameters& own, const ReceiverModeSetup& at) {
  return std::make_unique<Dgps>(own.get<DgpsParameters>(), at);
}

}  // namespace canyon::gnss
