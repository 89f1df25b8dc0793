#include "core/check.h"
#include "gnss/receiver/receiver_mode.h"

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
  explicit Single(const ReceiverModeParameters& p) : p_(p) {
    CANYON_CHECK(p_.ionosphere_correction == kNone || p_.ionosphere_correction == kHalf ||
                     p_.ionosphere_correction == kKlobuchar,
                 "ionosphere_correction = ", p_.ionosphere_correction);
  }

  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    const SkyView& v = in.receivers_view;
    if (p_.ionosphere && p_.ionosphere_correction == kHalf) c.modelled.ionosphere_m = 0.5 * in.acting.ionosphere_m;
    if (p_.ionosphere && p_.ionosphere_correction == kKlobuchar)
      c.modelled.ionosphere_m =
          klobuchar_delay_m(p_.klobuchar, v.t, v.receiver.lat_rad, v.receiver.lon_rad, v.azimuth_rad, v.elevation_rad);
    if (p_.troposphere) c.modelled.troposphere_m = standard_troposphere_m(v);
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

std::unique_ptr<ReceiverMode> make_single(const ReceiverModeParameters& p) {
  return std::make_unique<Single>(p);
}

}  // namespace canyon::gnss
