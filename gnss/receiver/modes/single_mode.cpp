#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

using Ionosphere = SingleFrequencyParameters::Ionosphere;

constexpr ModelRow<Ionosphere> kCorrections[] = {
    {"none", Ionosphere::kNone, "nothing"},
    {"half", Ionosphere::kHalf, "half of the true delay"},
    {"klobuchar", Ionosphere::kKlobuchar, "the broadcast model"},
};

/// A stand-alone single-frequency receiver.
///
/// Ionosphere: `klobuchar` subtracts the broadcast model; `half` subtracts half of the true delay, which is what the
/// broadcast model achieves on average (IS-GPS-200 20.3.3.5.2.5: at least 50 % of the RMS error); `none` nothing. What
/// remains is the difference. Troposphere: Saastamoinen and Niell with a standard atmosphere at the receiver's height
/// are subtracted; what remains is the weather's deviation from it, some centimetres at the zenith. Orbit and satellite
/// clock errors remain whole.
class Single final : public ReceiverMode {
 public:
  Single(const SingleFrequencyParameters& p, const ReceiverModeSetup& at) : p_(p), at_(at) {}

  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    c.modelled.ionosphere_m = modelled_ionosphere_m(p_.ionosphere_correction, at_, in);
    if (at_.troposphere) c.modelled.troposphere_m = standard_troposphere_m(in.receivers_view);
    return c;
  }
  FixStatus status() const override { return FixStatus::kSingle; }
  bool corrects_atmosphere() const override { return true; }

 private:
  SingleFrequencyParameters p_;
  ReceiverModeSetup at_;
};

}  // namespace

void visit(FieldVisitor& f, SingleFrequencyParameters& c) {
  f.choice("ionosphere_correction", c.ionosphere_correction, ModelTable<Ionosphere>(kCorrections),
           "mode single, and of mode dual satellites whose second signal is lost: what the receiver subtracts for the "
           "ionosphere");
}

double modelled_ionosphere_m(Ionosphere correction, const ReceiverModeSetup& at, const CorrectionInput& in) {
  const SkyView& v = in.receivers_view;
  if (!at.ionosphere || correction == Ionosphere::kNone) return 0.0;
  if (correction == Ionosphere::kHalf) return 0.5 * in.acting.ionosphere_m;
  return in.ionosphere_from_l1 *
         klobuchar_delay_m(at.klobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad, v.elevation_rad);
}

std::unique_ptr<ReceiverMode> make_single(const ModelParameters& own, const ReceiverModeSetup& at) {
  return std::make_unique<Single>(own.get<SingleFrequencyParameters>(), at);
}

}  // namespace canyon::gnss
