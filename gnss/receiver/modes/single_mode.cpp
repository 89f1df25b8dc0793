#include "canyon/core/check.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

constexpr const char* kNone = "none";
constexpr const char* kHalf = "half";
constexpr const char* kKlobuchar = "klobuchar";

/// A stand-alone single-frequency receiver.
///
/// Ionosphere: `klobuchar` subtracts the broadcast model; `half` subtracts half of the true delay, which is what the
/// broadcast model achieves on average (IS-GPS-200 20.3.3.5.2.5: at least 50 % of the RMS error); `none` nothing. What
/// remains is the difference. Troposphere: Saastamoinen and Niell with a standard atmosphere at the receiver's height
/// are subtracted; what remains is the weather's deviation from it, some centimetres at the zenith. Orbit and satellite
/// clock errors remain whole.
class Single final : public ReceiverMode {
 public:
  explicit Single(const ReceiverModeParameters& p) : p_(p) {}

  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    c.modelled.ionosphere_m = modelled_ionosphere_m(p_, in);
    if (p_.troposphere) c.modelled.troposphere_m = standard_troposphere_m(in.receivers_view);
    return c;
  }
  FixStatus status() const override { return FixStatus::kSingle; }
  bool corrects_atmosphere() const override { return true; }

 private:
  ReceiverModeParameters p_;
};

}  // namespace

std::vector<std::string> ionosphere_corrections() {
  return {kNone, kHalf, kKlobuchar};
}

double modelled_ionosphere_m(const ReceiverModeParameters& p, const CorrectionInput& in) {
  const std::string& model = p.ionosphere_correction;
  CANYON_CHECK(model == kNone || model == kHalf || model == kKlobuchar, "ionosphere_correction = ", model);
  const SkyView& v = in.receivers_view;
  if (!p.ionosphere || model == kNone) return 0.0;
  if (model == kHalf) return 0.5 * in.acting.ionosphere_m;
  return in.ionosphere_from_l1 *
         klobuchar_delay_m(p.klobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad, v.elevation_rad);
}

std::unique_ptr<ReceiverMode> make_single(const ReceiverModeParameters& p) {
  return std::make_unique<Single>(p);
}

}  // namespace canyon::gnss
