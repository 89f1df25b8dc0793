#include "gnss/receiver/receiver_mode.h"

namespace canyon::gnss {
namespace {

/// Every delay acts in full and nothing is subtracted: the paper's off-the-shelf receiver.
class SingleUncorrected final : public ReceiverMode {
 public:
  Correction correction(const CorrectionInput&) const override { return {}; }
  FixStatus status() const override { return FixStatus::kSingle; }
};

/// The paper's semantics of DGPS: "only the Troposphere errors will have an effect on the receiver-SV range"; they act
/// in full.
class DgpsPaper final : public ReceiverMode {
 public:
  RangeDelays acting(const RangeDelays& raw) const override { return {0.0, raw.troposphere_m, 0.0}; }
  Correction correction(const CorrectionInput&) const override { return {}; }
  FixStatus status() const override { return FixStatus::kDifferential; }
};

std::unique_ptr<ReceiverMode> make_single_uncorrected(const ReceiverModeParameters&) {
  return std::make_unique<SingleUncorrected>();
}
std::unique_ptr<ReceiverMode> make_dgps_paper(const ReceiverModeParameters&) {
  return std::make_unique<DgpsPaper>();
}

constexpr ModelRow<MakeReceiverMode> kModes[] = {
    {"single", make_single, "stand-alone: subtracts an ionosphere model and a standard troposphere"},
    {"single_uncorrected", make_single_uncorrected, "stand-alone as in the paper: every delay acts in full"},
    {"dgps", make_dgps, "differential: what the base station sees is subtracted, residuals grow with the baseline"},
    {"dgps_paper", make_dgps_paper, "the paper's differential mode: only the troposphere acts, in full"},
};

}  // namespace

std::span<const ModelRow<MakeReceiverMode>> receiver_modes() {
  return kModes;
}

}  // namespace canyon::gnss
