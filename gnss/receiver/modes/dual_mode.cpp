#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// Two frequencies: the ionosphere is what their pseudoranges differ by, I1 = (P2 - P1) / ((f1/f2)^2 - 1), so that the
/// corrected range is the ionosphere-free combination (f1^2 P1 - f2^2 P2) / (f1^2 - f2^2). First order in 1/f^2; the
/// higher orders are millimetres. Its price is in the same formula: noise and multipath of both signals come in, for
/// equal noise by 2.98 (L1 and L2) or 2.59 (L1 and L5). Of a satellite whose second signal is lost the ionosphere is
/// modelled as with one frequency: with half of the delay left over it is still worth its geometry. Troposphere:
/// Saastamoinen and Niell with a standard atmosphere at the receiver's height; orbit and satellite clock errors remain
/// whole.
class Dual final : public ReceiverMode {
 public:
  Dual(const SingleFrequencyParameters& p, const ReceiverModeSetup& at) : p_(p), at_(at) {}

  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    if (in.two) {
      c.noise_m = in.two->gain * in.two->noise_m;
      c.multipath_m = in.two->gain * in.two->multipath_m;
      c.modelled.ionosphere_m = in.two->gain * in.two->measured_m - c.noise_m - c.multipath_m;
    } else {
      c.modelled.ionosphere_m = modelled_ionosphere_m(p_.ionosphere_correction, at_, in);
    }
    if (at_.troposphere) c.modelled.troposphere_m = standard_troposphere_m(in.receivers_view);
    return c;
  }
  FixStatus status() const override { return FixStatus::kSingle; }
  bool dual_frequency() const override { return true; }
  bool corrects_atmosphere() const override { return true; }

 private:
  SingleFrequencyParameters p_;
  ReceiverModeSetup at_;
};

}  // namespace

std::unique_ptr<ReceiverMode> make_dual(const ModelParameters& own, const ReceiverModeSetup& at) {
  return std::make_unique<Dual>(own.get<SingleFrequencyParameters>(), at);
}

}  // namespace canyon::gnss
