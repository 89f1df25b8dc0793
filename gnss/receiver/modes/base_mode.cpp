#include "canyon/gnss/receiver/modes/air_between.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// Corrected by a base that is simulated too (gnss/sensor/base_receiver.h). The receiver subtracts a standard
/// troposphere at its own height, as the base has at its own, and what the base's range was off at its known place: the
/// ionosphere over the base, what the model leaves of the troposphere there, orbit and satellite clock as seen from
/// there, the base's own errors, and what is left of its clock. The correction is held from the base's epoch until the
/// next arrives; nothing is said of its rate.
///
/// The base's air is the rover's less what AirBetween gives for their distance, in addition to what the models
/// themselves differ by between two places. A range without a correction is not used.
class Base final : public ReceiverMode {
 public:
  Base(const DgpsParameters& p, const BaseStationParameters& base, const ReceiverModeSetup& at)
      : base_(base), at_(at), air_(p, at) {}

  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    if (at_.troposphere) c.modelled.troposphere_m = standard_troposphere_m(in.receivers_view);
    if (!in.base) return c;
    const RangeDelays& acting = in.base->acting;
    c.modelled.ionosphere_m = acting.ionosphere_m - air_.ionosphere_m(in, in.base->distance_km);
    c.modelled.troposphere_m += acting.troposphere_m - air_.troposphere_m(in, in.base->distance_km);
    c.modelled.ephemeris_m = acting.ephemeris_m;
    c.base_m = in.base->m - (acting.ionosphere_m + acting.troposphere_m + acting.ephemeris_m);
    return c;
  }
  int asks(const DelayOmissions&) const override { return at_.ionosphere + at_.troposphere; }
  FixStatus status() const override { return FixStatus::kDifferential; }
  const BaseStationParameters* base() const override { return &base_; }
  bool corrects_atmosphere() const override { return true; }

 private:
  BaseStationParameters base_;
  ReceiverModeSetup at_;
  AirBetween air_;
};

}  // namespace

void visit(FieldVisitor& f, BaseStationParameters& c) {
  f.vector3("base_place_m", c.place_m, {-500e3, 500e3}, "dgps_base: the base's antenna in the scene's frame W");
  f.file("base_receiver", c.receiver, ".toml",
         "dgps_base: the base's receiver, an entry of the catalogue or a TOML file of your own");
  f.number("base_rate_hz", c.rate_hz, {0.001, 20.0}, "dgps_base: epochs that the base sends per second");
  f.number("base_latency_s", c.latency_s, {0.0, 600.0}, "dgps_base: from the base's epoch until the receiver has it");
  f.number("base_age_s", c.age_s, {0.0, 3600.0}, "dgps_base: older corrections are not used");
}

std::unique_ptr<ReceiverMode> make_base(const ModelParameters& own, const ReceiverModeSetup& at) {
  return std::make_unique<Base>(own.get<DgpsParameters>(), own.get<BaseStationParameters>(), at);
}

}  // namespace canyon::gnss
